#!/usr/bin/env python3
"""Checks the documents: every relative link leads somewhere, and every command runs.

    docs_test.py links
    docs_test.py commands PROGRAM [--slow]

A block of commands is a fenced one of `sh` in which a line begins with "dermis ". Those of a document run in one new folder, in their
order. `--slow` also runs those behind the comment <!-- slow -->, which take longer than a quick check has.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
FENCED = re.compile(r"^(```+)(\w*)\n(.*?)^\1$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^ {4}.*$", re.MULTILINE)


def documents():
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=TOP,
                           capture_output=True, text=True)
    found = names.stdout.split() if names.returncode == 0 else [str(p.relative_to(TOP)) for p in TOP.glob("*.md")]
    assert found, "there are no documents"
    return found


def prose(text):
    """The text without blocks of code and code in a line, in which nothing is a link."""
    return re.sub(r"`[^`\n]*`", "", INDENTED.sub("", FENCED.sub("", text)))


def anchors(text):
    """The anchors that GitHub gives the headings."""
    found = set()
    for heading in re.findall(r"^#{1,6} +(.*?) *$", FENCED.sub("", text), re.MULTILINE):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        repeated = next(n for n in range(1000) if (f"{anchor}-{n}" if n else anchor) not in found)
        found.add(f"{anchor}-{repeated}" if repeated else anchor)
    return found


def check_links():
    checked, wrong = 0, []
    for name in documents():
        text = (TOP / name).read_text()
        for target in re.findall(r"\]\(([^)\s]+)\)", prose(text)):
            if re.match(r"[a-z]+:", target):
                continue
            checked += 1
            path, _, anchor = target.partition("#")
            file = (TOP / name).parent / path if path else TOP / name
            if not file.exists():
                wrong.append(f"{name}: {target}: no such file")
            elif anchor and anchor not in anchors(file.read_text()):
                wrong.append(f"{name}: {target}: no such heading")
    assert checked, "there are no links"
    return f"{checked} links", wrong


def commands(text):
    """The blocks that run dermis: the number of their first line, whether they are slow, and what they are."""
    for block in FENCED.finditer(text):
        if block[2] == "sh" and re.search(r"^dermis ", block[3], re.MULTILINE):
            is_slow = text[:block.start()].rstrip().endswith("<!-- slow -->")
            yield text.count("\n", 0, block.start()) + 2, is_slow, block[3]


def check_commands(program, runs_slow):
    run, wrong = 0, []
    for name in documents():
        with tempfile.TemporaryDirectory(prefix="dermis-docs-") as folder:
            os.symlink(program, Path(folder) / "dermis")
            work = Path(folder) / "work"
            work.mkdir()
            os.symlink(TOP / "examples", work / "examples")
            environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
            for line, is_slow, block in commands((TOP / name).read_text()):
                if is_slow and not runs_slow:
                    continue
                run += 1
                outcome = subprocess.run(["bash", "-e", "-c", block], cwd=work, env=environment, stdin=subprocess.DEVNULL,
                                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                if outcome.returncode != 0:
                    wrong.append(f"{name}:{line}: exit code {outcome.returncode}\n{block}{outcome.stdout}")
    assert run, "there are no commands"
    return f"{run} blocks of commands", wrong


def main(arguments):
    if arguments == ["links"]:
        checked, wrong = check_links()
    elif arguments[:1] == ["commands"] and len(arguments) in (2, 3) and arguments[2:] in ([], ["--slow"]):
        checked, wrong = check_commands(Path(arguments[1]).resolve(), len(arguments) == 3)
    else:
        sys.exit(__doc__)
    print("\n".join(wrong + [f"{checked}, {len(wrong)} wrong"]))
    sys.exit(1 if wrong else 0)


main(sys.argv[1:])
