"""The commands of the guide to FBX do what they say, as they are printed, against a real server."""

import shutil
import unittest

import guides
import tools

FILES = tools.SOURCE / "contrib" / "formats" / "tests" / "fbx" / "files"


class FormatsGuideTest(guides.GuideTest):
    @unittest.skipUnless(shutil.which("blender") and (tools.PROGRAMS / "duet-fbx").exists(),
                         "no blender, or no duet-fbx (it needs libassimp-dev)")
    def test_fbx(self):
        self.assertEqual(self.run_blocks("contrib/formats/fbx.md", files={
            "kick.fbx": FILES / "two_takes_30.fbx", "character.fbx": FILES / "still_skin.fbx"}), 3)


if __name__ == "__main__":
    tools.main()
