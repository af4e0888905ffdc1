#!/usr/bin/env python3
"""Makes the pictures of a server's answers: docs/images/reactions.png, and an animation of each class, of hands
that meet and of a dance in docs/images/reactions/. The leaders are samples/; needs chromium, python3-numpy and python3-pil.

    scripts/make_pictures.py build/release
"""

import base64
import io
import math
import os
import pathlib
import re
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
IMAGES = SOURCE / "docs" / "images"
os.environ["DUET_SOURCE_DIR"] = str(SOURCE)
os.environ["DUET_BIN_DIR"] = str(pathlib.Path(sys.argv[1]).resolve() / "bin")
sys.path.insert(0, str(SOURCE / "tests" / "e2e"))

import browser  # noqa: E402
import numpy as np  # noqa: E402
import tools  # noqa: E402
from PIL import Image  # noqa: E402

FILM = {"width": 360, "height": 240}
FILM_STEP = 6  # hundredths of a second between two pictures of a film: browsers slow down faster ones
MOST_PICTURES = 300  # of a film
UNCHANGED = 255  # the index of a pixel of a film that is as in the picture before
STILL = {"width": 467, "height": 396}
# (leader, labels, frame of the leader)
STILLS = (("kick", {"kick": 1}, 34), ("hug", {"hug": 1}, 50), ("push", {"hug": 0.5, "push": 0.5}, 34))
HANDS = ("shake_hands", ["--model=everyday", "--label=meet_hands=1"])
# The dance of scripts/demo.sh: its sample and its flags.
DANCE_OF_DEMO = (SOURCE / "scripts" / "demo.sh").read_text(encoding="utf-8").partition("dance() {")[2]
DANCE = ("salsa", ["--model=salsa", *(f"{flag}={value}" for flag, value in
                                      re.findall(r"(--candidates|--seed|--keyframe) (\d\S*)", DANCE_OF_DEMO))])
# A frame of the page without its controls, as a data URL.
PICTURE = ("(() => {{ const stage = document.getElementById('stage'); stage.player.seek({frame}); stage.draw();"
           " return stage.canvas.toDataURL(); }})()")


def label_flags(labels):
    return [f"--label={name}={weight}" for name, weight in labels.items()]


def page_of(server, leader, flags, folder):
    """The viewer's page for a sample and its answer."""
    file = folder / f"{leader}-{len(flags)}.html"
    tools.duet("synthesize", "--server", server.address, "--leader", tools.sample(leader), *flags,
               "--out", file).check_returncode()
    return file.as_uri()


def decoded(url):
    """The bytes of a data URL."""
    return base64.b64decode(url.partition(",")[2])


def film_pictures(page):
    """The pictures of one run, and the hundredths of a second that each is shown."""
    last, rate = page.evaluate("(({player, motion}) => [player.last, motion.frameRate])"
                               "(document.getElementById('stage'))")
    hundredths = max(FILM_STEP, math.ceil(100 * last / rate / MOST_PICTURES))
    step = rate * hundredths / 100
    frames = [step * index for index in range(int(last / step) + 1)]
    return [Image.open(io.BytesIO(decoded(page.evaluate(PICTURE.format(frame=frame))))).convert("RGB")
            .resize(tuple(FILM.values()), Image.LANCZOS) for frame in frames], hundredths


def save_film(chromium, url, file):
    """Saves one run as a GIF that repeats, with one palette and in each picture only what has changed."""
    page = chromium.open(f"{url}#paused", sharp=True, **FILM)
    pictures, hundredths = film_pictures(page)
    page.close()
    some = np.concatenate([np.asarray(picture) for picture in pictures[::max(1, len(pictures) // 5)]])
    palette = Image.fromarray(some).quantize(UNCHANGED)
    shown = [np.asarray(picture.quantize(palette=palette, dither=Image.Dither.NONE)) for picture in pictures]
    changes = [shown[0], *(np.where(now == before, UNCHANGED, now).astype(np.uint8)
                           for before, now in zip(shown, shown[1:]))]
    first, *others = (Image.fromarray(indices, "P") for indices in changes)
    for picture in (first, *others):
        picture.putpalette(palette.getpalette())
    first.save(file, save_all=True, append_images=others, duration=10 * hundredths, loop=0, disposal=1,
               transparency=UNCHANGED, optimize=False)


def take_still(chromium, url, frame):
    """A frame as a data URL without the page's controls."""
    page = chromium.open(f"{url}#paused", sharp=True, **STILL)
    picture = page.evaluate(PICTURE.format(frame=frame))
    page.close()
    return picture


def save_side_by_side(chromium, pictures, file, folder):
    html = folder / "together.html"
    images = "".join(f'<img src="{picture}">' for picture in pictures)
    html.write_text(f'<html data-state="ready"><body style="margin:0;display:flex">{images}',
                    encoding="utf-8")
    page = chromium.open(html.as_uri(), STILL["width"] * len(pictures), STILL["height"], sharp=True)
    file.write_bytes(base64.b64decode(page.call("Page.captureScreenshot", format="png")["data"]))
    page.close()


def main():
    (IMAGES / "reactions").mkdir(exist_ok=True)
    server = tools.Server()
    chromium = browser.Browser()
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for leader in tools.CLASSES:
                save_film(chromium, page_of(server, leader, label_flags({leader: 1}), folder),
                          IMAGES / "reactions" / f"{leader}.gif")
            for film, (leader, flags) in {"hands": HANDS, "dance": DANCE}.items():
                save_film(chromium, page_of(server, leader, flags, folder), IMAGES / "reactions" / f"{film}.gif")
            stills = [take_still(chromium, page_of(server, leader, label_flags(labels), folder), frame)
                      for leader, labels, frame in STILLS]
            save_side_by_side(chromium, stills, IMAGES / "reactions.png", folder)
    finally:
        chromium.close()
        server.stop()


if __name__ == "__main__":
    main()
