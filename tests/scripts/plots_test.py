import importlib.util
import tempfile
import unittest
from pathlib import Path

import report_example as example
from report import latent, plots, poses

HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None
HAS_SKLEARN = importlib.util.find_spec("sklearn") is not None


@unittest.skipUnless(HAS_MATPLOTLIB, "needs python3-matplotlib")
class DrawTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        plots.use_matplotlib()

    def draw(self, plot):
        files, remark = plots.draw_plot(plot, self.folder, "figure")
        return files, remark, (self.folder / "figure.svg").read_text(encoding="utf-8")

    def test_the_same_data_gives_the_same_file(self):
        first = self.draw(example.pose_plot())[2]
        self.assertEqual(first, self.draw(example.pose_plot())[2])

    def test_a_strip_has_a_row_for_each_pair_and_an_animation(self):
        files, _, svg = self.draw(example.pose_plot())
        self.assertEqual(files, ["figure.svg", "figure_moving.gif"])
        for text in ("kick", "captured", "ours", "0.0 s", "0.7 s"):
            self.assertIn(f">{text}</text>", svg)
        from PIL import Image
        with Image.open(self.folder / "figure_moving.gif") as animation:
            self.assertGreaterEqual(animation.n_frames, 12)

    def test_leaders_are_on_the_left_and_up_is_up(self):
        pair = poses.project(example.pose_plot()["pairs"], 0)[0]
        self.assertLess(pair["leader"][0][0][0], pair["follower"][0][0][0])
        self.assertLess(pair["leader"][0][0][1], pair["leader"][0][1][1])

    def test_a_short_clip_shows_each_frame_once(self):
        self.assertEqual(poses.moments(3), [0, 1, 2])
        self.assertEqual(poses.moments(1), [0])
        self.assertEqual(poses.moments(8), list(range(8)))

    @unittest.skipUnless(HAS_SKLEARN, "needs python3-sklearn")
    def test_a_latent_map_keeps_classes_together(self):
        plot = example.latent_plot()
        _, remark, svg = self.draw(plot)
        self.assertEqual(remark, "In the map, the nearest neighbour of 1.000 of the clips has "
                                 "their class.")
        for text in ("ours", "kick", "hug"):
            self.assertIn(f">{text}</text>", svg)
        points = latent.embed(plot["features"], plot["perplexity"], plot["seed"])
        self.assertLess(latent.purity(points, [i % 2 for i in range(20)]), 0.5)


if __name__ == "__main__":
    unittest.main()
