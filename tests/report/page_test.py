"""The page of `dermis filter --report`, as a browser without a window shows it: page_test.py DERMIS PICTURE FOLDER.

It needs chromium, and Debian's Pillow to look at what is on the screen. The screenshot stays in the folder.
"""
import pathlib
import subprocess
import sys

from PIL import Image, ImageChops, ImageStat

WIDTH_PX = 1200
PADDING_PX = 15  # of the page, on either side


def difference(a, b):
    """The mean difference of two pictures of one size, in steps of 1/255."""
    return sum(ImageStat.Stat(ImageChops.difference(a, b)).mean) / 3


def main():
    dermis, picture, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    subprocess.run(
        [dermis, "filter", picture, "-o", folder / "out.exr", "--mm-per-unit", "10", "--material", "1=skin",
         "--material", "2=marble", "--material", "3=wax", "--report", folder, "--preview", folder / "after.png", "--quiet"],
        check=True)
    subprocess.run([dermis, "preview", picture, "-o", folder / "before.png"], check=True)
    screenshot = folder / "screenshot.png"
    subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--user-data-dir={folder}/user",
         f"--window-size={WIDTH_PX},1500", f"--screenshot={screenshot}", (folder / "index.html").as_uri()],
        check=True, timeout=120, stderr=subprocess.DEVNULL)
    screen = Image.open(screenshot).convert("RGB")

    width = WIDTH_PX - 2 * PADDING_PX
    before, after = (Image.open(folder / f"{name}.png").convert("RGB") for name in ("before", "after"))
    height = width * before.height // before.width
    before, after = (its.resize((width, height), Image.BICUBIC) for its in (before, after))
    half = width // 2 - 2  # without the line in the middle
    left, right = (0, 0, half, height), (width - half, 0, width, height)

    def shown(area, top):
        x, y, end_x, end_y = area
        return screen.crop((PADDING_PX + x, top + y, PADDING_PX + end_x, top + end_y))

    top = min(range(40, 200), key=lambda y: difference(shown(left, y), before.crop(left)))
    off = {
        (side, name): difference(shown(area, top), its.crop(area))
        for side, area in (("left", left), ("right", right))
        for name, its in (("before", before), ("after", after))
    }
    print(f"the pictures begin {top} px from the top; off by", off)
    # A browser scales pictures its own way, which is off by less than a step of 8 bits in the mean.
    assert off["left", "before"] < 1 and off["left", "before"] < off["left", "after"], "before is not on the left"
    assert off["right", "after"] < 1 and off["right", "after"] < off["right", "before"], "after is not on the right"
    below = screen.crop((0, top + height, WIDTH_PX, top + height + 300))
    assert len(set(below.getdata())) > 500, "there are no maps below"


main()
