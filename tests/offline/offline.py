#!/usr/bin/env python3
"""What GPUs would make of the kernels, without a GPU.

    offline.py PROGRAMS [--ptxas FILE] [--assert]

PROGRAMS is build/bin/kernel_programs, which writes the programs that plans build, with their options. Those for GPUs are compiled
by clang for sm_90 (NVPTX, and ptxas if it is there) and for gfx1030 (AMDGPU), with the built-in functions of libclc; all of them go
through llvm-spirv. Prints a table of registers, bytes of stack, of spills and of local memory, and the share of the most threads
that a processor can hold. `--assert` fails where a kernel of the separable method spills, has a stack or needs more than 128
registers, and where llvm-spirv refuses a program.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

CLANG = "clang-15"
SPIRV = "llvm-spirv-15"
BUILT_IN = "/usr/lib/clc/"
MOST_REGISTERS = 128

# Kernels of the plans of the separable method that do not keep the bounds yet, for all plans or for those with many images: arrays
# with an index that varies (curvature, view_surface), pow of libclc (prepare, finish), too many registers (hidden_light).
NOT_YET = {"curvature", "finish", "hidden_light", "prepare", "view_surface"}


class Program(NamedTuple):
    file: Path
    device: str  # "GPU" or "CPU"
    plan: str
    options: list


class Use(NamedTuple):
    """What a kernel takes of a processor."""
    registers: int
    stack: int  # bytes of a work-item
    spilled: int  # bytes or registers
    local: int  # bytes of a work-group
    occupancy: float  # of the most threads

    def is_good(self):
        return self.registers <= MOST_REGISTERS and self.stack == 0 and self.spilled == 0


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{command[0]}: {(done.stderr.strip() or done.stdout.strip())[:400]}")
    return done.stdout + done.stderr


def compile_to(program, output, target, *more):
    run(CLANG, "-x", "cl", "-target", target, *program.options, "-O3", "-w", *more, "-o", output, program.file)


def with_library(name):
    return "-S", "-nogpulib", "-Xclang", "-mlink-builtin-bitcode", "-Xclang", BUILT_IN + name


def group_size(program, kernel, otherwise=64):
    """The work-items of a work-group: as the kernel asks, else as the host launches it."""
    source = program.file.read_text()
    asked = re.search(r"reqd_work_group_size\((\w+), (\w+), 1\)\)\) void %s\(" % kernel, source)
    if not asked:
        return otherwise
    values = dict(re.findall(r"#define (\w+) (\d+)", source))
    return int(values.get(asked[1], asked[1])) * int(values.get(asked[2], asked[2]))


def of_nvidia(program, folder, ptxas):
    """The kernels of a program on sm_90: 65536 registers in parts of 256 for a warp, 64 warps, 32 groups, 227 KiB of local memory."""
    ptx = folder / f"{program.file.stem}.ptx"
    compile_to(program, ptx, "nvptx64--nvidiacl", "-Xclang", "-target-cpu", "-Xclang", "sm_80", *with_library("nvptx64--nvidiacl.bc"))
    if ptxas is None:
        return {}
    text = run(ptxas, "-v", "-arch=sm_90", "-o", os.devnull, ptx)
    uses = {}
    for part in text.split("Compiling entry function ")[1:]:
        name = re.match(r"'(\w+)'", part)[1]
        frames = re.findall(r"(\d+) bytes stack frame, (\d+) bytes spill stores", part)
        registers = int(re.search(r"Used (\d+) registers", part)[1])
        stack = max([int(f[0]) for f in frames] + [int(n) for n in re.findall(r"(\d+) bytes cumulative stack", part)])
        local = int(next(iter(re.findall(r"(\d+) bytes smem", part)), 0))
        warps = -(-group_size(program, name) // 32)
        groups = min(32, 64 // warps, 65536 // (-(-registers * 32 // 256) * 256 * warps), 227 * 1024 // local if local else 64)
        uses[name] = Use(registers, stack, sum(int(f[1]) for f in frames), local, groups * warps / 64)
    return uses


def of_amd(program, folder):
    """The kernels of a program on gfx1030, as its compiler counts: at most 16 waves."""
    assembly = folder / f"{program.file.stem}.s"
    compile_to(program, assembly, "amdgcn-amd-amdhsa", "-mcpu=gfx1030", *with_library("amdgcn--amdhsa.bc"))
    text = assembly.read_text()
    uses = {}
    for name, counts in re.findall(r"\.amdhsa_kernel (\w+)\n.*?; Kernel info:\n(.*?)\n\t\.text", text + "\n\t.text", re.DOTALL):
        number = {key: int(value) for key, value in re.findall(r"; (\w+): (\d+)", counts)}
        its = re.search(r"\.name: +%s\n.*?\.vgpr_spill_count: +(\d+)" % name, text, re.DOTALL)
        spilled = int(its[1]) if its else 0
        uses[name] = Use(number["NumVgprs"], number["ScratchSize"], spilled, number["LDSByteSize"], number["Occupancy"] / 16)
    return uses


def through_spirv(program, folder):
    """The error of llvm-spirv, or None."""
    bitcode = folder / f"{program.file.stem}.bc"
    try:
        # Drivers translate what their compiler has not optimised yet.
        compile_to(program, bitcode, "spir64", "-Xclang", "-disable-llvm-passes", "-emit-llvm", "-c")
        run(SPIRV, bitcode, "-o", folder / f"{program.file.stem}.spv")
    except RuntimeError as error:
        return str(error)
    return None


def programs_of(writer, folder):
    lines = run(writer, folder).splitlines()
    for number, device, plan, options in (line.split("\t") for line in lines):
        yield Program(folder / f"{number}.cl", device, plan, options.split())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs")
    parser.add_argument("--ptxas", default=shutil.which("ptxas", path=os.environ["PATH"] + ":/usr/local/cuda/bin"))
    parser.add_argument("--assert", dest="asserts", action="store_true")
    arguments = parser.parse_args()
    problems = []
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(os.cpu_count()) as pool:
        folder = Path(name)
        programs = list(programs_of(arguments.programs, folder))
        assert programs, "there are no programs"
        for program, error in zip(programs, pool.map(lambda p: through_spirv(p, folder), programs)):
            if error:
                problems.append(f"{program.plan} ({program.device}): {error}")
        on_gpus = [program for program in programs if program.device == "GPU"]
        for target, compiled in (("sm_90", lambda p: of_nvidia(p, folder, arguments.ptxas)), ("gfx1030", lambda p: of_amd(p, folder))):
            print(f"{target:8} {'kernel':16} registers   stack  spilled   local  occupancy  plan")
            seen = set()
            for program, uses in zip(on_gpus, pool.map(compiled, on_gpus)):
                for kernel, use in sorted(uses.items()):
                    if (kernel, use) not in seen:
                        seen.add((kernel, use))
                        print(f"{'' if use.is_good() else '*':8} {kernel:16} {use.registers:9} {use.stack:7} {use.spilled:8} "
                              f"{use.local:7} {use.occupancy:9.0%}  {program.plan}")
                    if not use.is_good() and program.plan.startswith("separable") and kernel not in NOT_YET:
                        problems.append(f"{target}: {kernel} of \"{program.plan}\": {use.registers} registers, {use.stack} bytes of "
                                        f"stack, {use.spilled} spilled; wanted at most {MOST_REGISTERS}, 0 and 0")
            print()
    print(f"{len(programs)} programs, {len(programs) - sum('llvm-spirv' in p for p in problems)} of them through llvm-spirv")
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems and arguments.asserts else 0


if __name__ == "__main__":
    sys.exit(main())
