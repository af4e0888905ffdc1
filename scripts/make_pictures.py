#!/usr/bin/env python3
"""Makes the pictures of a server's answers: docs/images/reactions.png, and an animation of each class and of a
dance in docs/images/reactions/. The leaders are samples/; needs chromium.

    scripts/make_pictures.py build/release
"""

import base64
import os
import pathlib
import re
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
IMAGES = SOURCE / "docs" / "images"
DEMO = SOURCE / "scripts" / "demo.sh"
os.environ["DUET_SOURCE_DIR"] = str(SOURCE)
os.environ["DUET_BIN_DIR"] = str(pathlib.Path(sys.argv[1]).resolve() / "bin")
sys.path.insert(0, str(SOURCE / "tests" / "e2e"))

import browser  # noqa: E402
import tools  # noqa: E402

browser.WAIT_SECONDS = 900  # a film of half a minute takes minutes where a processor draws it
FILM = {"width": 360, "height": 240}
STILL = {"width": 467, "height": 396}
# (leader, labels, frame of the leader)
STILLS = (("kick", {"kick": 1}, 34), ("hug", {"hug": 1}, 50), ("push", {"hug": 0.5, "push": 0.5}, 34))
# The dance of scripts/demo.sh: its sample and its flags.
DANCE = ("salsa", ["--model=salsa", *(f"{flag}={value}" for flag, value in
                                      re.findall(r"(--candidates|--seed|--keyframe) (\d\S*)", DEMO.read_text(encoding="utf-8")))])
KEEP_BLOBS = ("(() => { const make = URL.createObjectURL; URL.createObjectURL = (blob) => {"
              " window.saved = blob; return make(blob); }; })()")
SAVED = ("new Promise((resolve) => { const reader = new FileReader();"
         " reader.onload = () => resolve(reader.result.split(',')[1]);"
         " reader.readAsDataURL(window.saved); })")


def label_flags(labels):
    return [f"--label={name}={weight}" for name, weight in labels.items()]


def page_of(server, leader, flags, folder):
    """The viewer's page for a sample and its answer."""
    file = folder / f"{leader}-{len(flags)}.html"
    tools.duet("synthesize", "--server", server.address, "--leader", tools.sample(leader), *flags,
               "--out", file).check_returncode()
    return file.as_uri()


def save_film(chromium, url, file):
    page = chromium.open(f"{url}#paused", sharp=True, **FILM)
    page.evaluate(KEEP_BLOBS)
    page.press("g")
    page.wait_until("(document.documentElement.dataset.saved || '').includes('.gif')")
    file.write_bytes(base64.b64decode(page.evaluate(SAVED)))
    page.close()


def take_still(chromium, url, frame):
    """A frame as a data URL without the page's controls."""
    page = chromium.open(f"{url}#frame={frame}&paused", sharp=True, **STILL)
    picture = page.evaluate("(() => { const stage = document.getElementById('stage'); stage.draw();"
                            " return stage.canvas.toDataURL(); })()")
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
            save_film(chromium, page_of(server, *DANCE, folder), IMAGES / "reactions" / "dance.gif")
            stills = [take_still(chromium, page_of(server, leader, label_flags(labels), folder), frame)
                      for leader, labels, frame in STILLS]
            save_side_by_side(chromium, stills, IMAGES / "reactions.png", folder)
    finally:
        chromium.close()
        server.stop()


if __name__ == "__main__":
    main()
