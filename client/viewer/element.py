#!/usr/bin/env python3
"""Makes the viewer's element, <duet-motion>, as one script that needs no other (docs/viewer_element.md).

    client/viewer/element.py duet-motion.js

three.js is Debian's (libjs-three).
"""

import pathlib
import sys

PAGE = pathlib.Path(__file__).resolve().parent / "page"
THREE = pathlib.Path("/usr/share/javascript/three")
PARTS = ("motion.js", "scenery.js", "figure.js", "stage.js", "player.js", "element.js")
# three.js and its controls are given modules of their own, so that they leave no name behind and
# meet no other three.js of the page.
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
