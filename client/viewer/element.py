#!/usr/bin/env python3
"""Builds the viewer element, <duet-motion>, as one self-contained script (docs/viewer_element.md).

    client/viewer/element.py duet-motion.js

It contains three.js from Debian's libjs-three.
"""

import pathlib
import sys

PAGE = pathlib.Path(__file__).resolve().parent / "page"
THREE = pathlib.Path("/usr/share/javascript/three")
PARTS = ("motion.js", "scenery.js", "figure.js", "stage.js", "player.js", "element.js")
# three.js and its controls get their own modules, so that they define no global names and do not
# affect another three.js on the page.
WRAPPED = """{licence}
(() => {{
const THREE = {{}};
(function (exports, module) {{
{three}
}})(THREE, {{}});
(function (exports, module, require) {{
{controls}
}})(THREE, {{}}, () => THREE);
(() => {{
'use strict';
{parts}
}})();
}})();
"""


def script():
    """The text of duet-motion.js."""
    def read(file):
        return file.read_text(encoding="utf-8")
    return WRAPPED.format(
        licence=read(PAGE / "three_licence.js"), three=read(THREE / "three.min.js"),
        controls=read(THREE / "examples" / "js" / "controls" / "OrbitControls.js"),
        parts="".join(read(PAGE / part) for part in PARTS))


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    pathlib.Path(arguments[0]).write_text(script(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
