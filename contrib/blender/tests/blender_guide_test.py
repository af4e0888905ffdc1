"""The guide to the first ten minutes in Blender does what it says."""

import shutil

import guides
import tools


class BlenderGuideTest(guides.GuideTest):
    def test_the_first_ten_minutes(self):
        self.assertEqual(self.run_blocks("contrib/blender/ten_minutes.md"), 3)


if __name__ == "__main__":
    if not shutil.which("blender"):
        tools.skip("no blender; install the package blender")
    tools.main()
