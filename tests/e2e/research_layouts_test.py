"""The layouts of research agree with their published definitions, as NumPy computes them here anew:
HumanML3D's 263 and InterGen's 262 numbers, and the joints of a body model of the SMPL family."""

import importlib.util
import json
import pathlib
import tempfile
import unittest

import tools

if importlib.util.find_spec("numpy") is None:
    tools.skip("no Python module numpy; install the package python3-numpy")

import numpy as np  # noqa: E402

DUET = tools.PROGRAMS / "duet"
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]
CHAINS = [[0, 2, 5, 8, 11], [0, 1, 4, 7, 10], [0, 3, 6, 9, 12, 15], [9, 14, 17, 19, 21],
          [9, 13, 16, 18, 20]]
REST = np.zeros((22, 3))
REST[[1, 13]], REST[[2, 14]], REST[[3, 6, 9, 12]] = (1, 0, 0), (-1, 0, 0), (0, 1, 0)
REST[[10, 11, 15]], REST[[4, 5, 7, 8, 16, 17, 18, 19, 20, 21]] = (0, 0, 1), (0, -1, 0)
FEET = [7, 10, 8, 11]


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def between(u, v):
    """The matrix of the smallest rotation from one unit vector to another (Rodrigues)."""
    w, c = np.cross(u, v), np.dot(u, v)
    k = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    return np.eye(3) + k + k @ k / (1 + c)


def about_y(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def heading(ahead):
    """The angle about y that takes a horizontal direction to z."""
    return -np.arctan2(ahead[..., 0], ahead[..., 2])


def placed(positions, across):
    """On the floor, the first root at x = z = 0, turned so that its person faces z."""
    moved = positions.astype(np.float64).copy()
    moved[..., 1] -= moved[..., 1].min()
    moved -= moved[0, 0] * [1, 0, 1]
    return moved @ about_y(heading(np.cross([0, 1, 0], across(moved[0])))).T


def humanml3d(positions):
    at = placed(positions, lambda p: p[2] - p[1] + p[17] - p[16])
    ahead = np.cross([0, 1, 0], unit(at[:, 1] - at[:, 2] + at[:, 17] - at[:, 16]))
    weights = np.exp(-0.5 * (np.arange(-80, 81) / 20.0) ** 2)
    padded = np.pad(ahead, ((80, 80), (0, 0)), mode="edge")
    smooth = np.stack([np.convolve(padded[:, i], weights / weights.sum(), "valid")
                       for i in range(3)], axis=1)
    angles = np.unwrap(heading(smooth))
    turns = np.stack([about_y(angle) for angle in angles])
    rows = []
    for t in range(len(at) - 1):
        local = (at[t] - at[t, 0] * [1, 0, 1]) @ turns[t].T
        rotations = np.zeros((22, 6))
        for chain in CHAINS:
            before = turns[t]
            for parent, joint in zip(chain, chain[1:]):
                rotation = between(REST[joint], unit(at[t, joint] - at[t, parent]))
                rotations[joint] = (before.T @ rotation)[:, :2].T.ravel()
                before = rotation
        way = turns[t + 1] @ (at[t + 1, 0] - at[t, 0])
        stays = ((at[t + 1, FEET] - at[t, FEET]) ** 2).sum(axis=-1) < 0.002
        rows.append(np.concatenate([
            [(angles[t + 1] - angles[t]) / 2, way[0], way[2], at[t, 0, 1]], local[1:].ravel(),
            rotations[1:].ravel(), ((at[t + 1] - at[t]) @ turns[t].T).ravel(), stays]))
    return np.array(rows)


def intergen(people):
    """Without the rotations, which positions do not define."""
    first = people[0].astype(np.float64)
    turn = about_y(heading(np.cross([0, 1, 0], first[0, 2] - first[0, 1])))
    rows = []
    for person in people:
        at = person.astype(np.float64) - first[0, 0] * [1, 0, 1]
        at[..., 1] -= at[..., 1].min()
        at = at @ turn.T
        way = at[1:] - at[:-1]
        stays = ((way[:, FEET] ** 2).sum(axis=-1) < 0.001) & (
            at[:-1, FEET, 1] < [0.12, 0.05, 0.12, 0.05])
        rows.append((at[:-1].reshape(len(way), -1), way.reshape(len(way), -1), stays))
    return rows


def axis_angle(v):
    angle = np.linalg.norm(v)
    if angle == 0:
        return np.eye(3)
    x, y, z = v / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def body_model(random, path):
    """A body of 22 x 8 vertices, in a T pose; its joints are means of vertices."""
    rest = np.array([
        [0, .1, 0], [.1, 0, 0], [-.1, 0, 0], [0, .2, 0], [.1, -.4, 0], [-.1, -.4, 0], [0, .3, 0],
        [.1, -.8, 0], [-.1, -.8, 0], [0, .4, 0], [.1, -.85, .1], [-.1, -.85, .1], [0, .6, 0],
        [.08, .5, 0], [-.08, .5, 0], [0, .7, 0], [.2, .5, 0], [-.2, .5, 0], [.5, .5, 0],
        [-.5, .5, 0], [.75, .5, 0], [-.75, .5, 0]])
    vertices = (rest[:, None] + random.normal(0, .02, (22, 8, 3))).reshape(-1, 3)
    regressor = np.zeros((24, 176))
    for joint in range(22):
        regressor[joint, 8 * joint:8 * joint + 8] = 1 / 8
    model = {"v_template": vertices, "J_regressor": regressor,
             "shapedirs": random.normal(0, .002, (176, 3, 10)),
             "kintree_table": np.array([[2 ** 32 - 1] + PARENTS[1:] + [20, 21], range(24)],
                                       dtype=np.uint32),
             "posedirs": np.zeros((176, 3, 207)), "gender": np.array("neutral")}
    np.savez_compressed(path, **model)
    return model


def smpl_joints(model, poses, trans, betas):
    vertices = model["v_template"] + model["shapedirs"] @ betas
    rest = (model["J_regressor"] @ vertices)[:22]
    people = np.zeros((len(poses), 22, 3))
    for t, pose in enumerate(poses):
        world = []
        for joint in range(22):
            local, parent = axis_angle(pose[3 * joint:3 * joint + 3]), PARENTS[joint]
            world.append(local if parent < 0 else world[parent] @ local)
            people[t, joint] = (rest[0] + trans[t] if parent < 0 else
                                people[t, parent] + world[parent] @ (rest[joint] - rest[parent]))
    return people


class ResearchLayoutsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def duet(self, *arguments, code=0):
        ran = tools.run(DUET, *arguments, cwd=self.folder)
        self.assertEqual(ran.returncode, code, ran.stdout + ran.stderr)
        return ran.stdout + ran.stderr

    def convert(self, source, out, *arguments):
        self.duet("convert", source, "--out", out, "--quiet", *arguments)
        return np.load(self.folder / out)

    def turning(self, frames=240):
        """Positions of a sample, walked along a curve with more than a full turn."""
        one = self.convert(tools.sample("hug"), "hug.npy", "--output-layout", "humanml3d")
        self.assertEqual(one.shape[1:], (22, 3))
        return np.stack([
            (one[t % len(one)] - one[0, 0]) @ about_y(0.035 * t).T + [0.01 * t, 1, np.sin(t / 40)]
            for t in range(frames)]).astype(np.float32)

    def test_humanml3d_features_follow_their_definition(self):
        positions = self.turning()
        np.save(self.folder / "turning.npy", positions)
        features = self.convert("turning.npy", "features.npy", "--layout", "humanml3d",
                                "--output-layout", "humanml3d-263")
        self.assertEqual(features.shape, (len(positions) - 1, 263))
        difference = np.abs(features - humanml3d(positions))
        self.assertLess(difference.max(), 1e-4, np.argwhere(difference > 1e-4)[:5])

    def test_humanml3d_features_give_the_positions_back(self):
        positions = self.turning()
        np.save(self.folder / "turning.npy", positions)
        self.convert("turning.npy", "features.npy", "--layout", "humanml3d", "--output-layout",
                     "humanml3d-263")
        again = self.convert("features.npy", "again.npy", "--output-layout", "humanml3d")
        self.assertEqual(again.shape, (len(positions) - 1, 22, 3))
        # The same motion, moved and turned as a whole: aligned by its first frame.
        at = positions[:-1].astype(np.float64)
        moved = [p - p[0, 0] for p in (at, again.astype(np.float64))]
        across = [p[0, 2] - p[0, 1] for p in moved]
        turn = about_y(heading(across[0]) - heading(across[1]))
        self.assertLess(np.abs(moved[0] @ turn.T - moved[1]).max(), 1e-3)

    def test_intergen_features_follow_their_definition(self):
        first = self.turning(120)
        second = first[::-1] @ about_y(2).T + np.array([0.5, 0.3, 1.5])
        np.save(self.folder / "pair.npy", np.stack([first, second]).astype(np.float32))
        features = self.convert("pair.npy", "features.npy", "--layout", "intergen",
                                "--output-layout", "intergen-262")
        self.assertEqual(features.shape, (2, 119, 262))
        for person, (positions, ways, stays) in zip(
                features, intergen(np.load(self.folder / "pair.npy"))):
            self.assertLess(np.abs(person[:, :66] - positions).max(), 1e-4)
            self.assertLess(np.abs(person[:, 66:132] - ways).max(), 1e-4)
            np.testing.assert_array_equal(person[:, 258:], stays)
            # Rows of the first two columns: unit vectors at a right angle.
            columns = person[:, 132:258].reshape(-1, 3, 2)
            gram = np.einsum("nij,nik->njk", columns, columns)
            self.assertLess(np.abs(gram - np.eye(2)).max(), 1e-4)
        # InterGen's own array has both people in a row.
        np.save(self.folder / "row.npy", np.concatenate(list(features), axis=1))
        again = self.convert("row.npy", "again.npy", "--output-layout", "intergen")
        np.testing.assert_allclose(again, features[..., :66].reshape(2, 119, 22, 3), atol=1e-6)

    def test_body_models_pose_their_joints(self):
        random = np.random.default_rng(5)
        model = body_model(random, self.folder / "body.npz")
        poses = np.zeros((40, 156))
        poses[:, :66] = random.normal(0, 0.3, 66) * np.linspace(0, 1, 40)[:, None]
        poses[:, 0] += np.pi / 2  # AMASS: z up
        poses[:, 66:] = random.normal(0, 1, 90)  # fingers are not used
        trans = np.linspace([0, 0, .9], [1, 2, 1], 40)
        betas = random.normal(0, 1, 16)
        np.savez(self.folder / "amass.npz", poses=poses, trans=trans, betas=betas,
                 gender="neutral", mocap_framerate=20.0, dmpls=np.zeros((40, 8)))
        read = self.convert("amass.npz", "joints.npy", "--body-model", "body.npz",
                            "--output-layout", "humanml3d")
        expected = smpl_joints(model, poses, trans, betas[:10])
        expected = np.stack([expected[..., 0], expected[..., 2], -expected[..., 1]], axis=-1)
        self.assertLess(np.abs(read - expected).max(), 1e-4)
        # The same motion as Inter-X keeps it, without a rate.
        np.savez_compressed(self.folder / "interx.npz", root_orient=poses[:, :3],
                            pose_body=poses[:, 3:66].reshape(40, 21, 3), trans=trans,
                            betas=betas[None], gender="neutral")
        again = self.convert("interx.npz", "again.npy", "--body-model", "body.npz",
                             "--frame-rate", "20", "--output-layout", "humanml3d")
        np.testing.assert_allclose(again, read, atol=1e-6)

    def imported(self, captures, *arguments):
        """The last line that duet-import prints of a folder."""
        ran = tools.run(tools.PROGRAMS / "duet-import", "--from", captures, "--out",
                        self.folder / f"{captures.name}_set", *arguments)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        return ran.stdout.splitlines()[-1]

    def test_arrays_of_two_people_become_a_data_set(self):
        one = self.turning(60)
        other = (one @ about_y(np.pi).T + [0, 0, 1.5]).astype(np.float32)
        captures = self.folder / "arrays"
        for label in ("hug", "kick"):
            (captures / label).mkdir(parents=True)
            np.save(captures / label / "01.npy", np.stack([one, other]))
        self.assertIn("2 sequences of 2 pairs; 0 refused",
                      self.imported(captures, "--layout", "inter-x"))

    def test_pairs_of_body_models_become_a_data_set(self):
        captures = self.folder / "bodies"
        for label in ("hug", "kick"):
            (captures / label).mkdir(parents=True)
            for person, place in (("a", (0, 0, .9)), ("b", (0, 1, .9))):
                poses = np.zeros((60, 66))
                poses[:, 0], poses[:, 50] = np.pi / 2, np.linspace(0, 1, 60)
                np.savez(captures / label / f"01_{person}.npz", poses=poses, fps=20,
                         trans=np.tile(place, (60, 1)))
        body_model(np.random.default_rng(5), captures / "body.npz")  # is no motion
        self.assertIn("2 sequences of 2 pairs; 0 refused",
                      self.imported(captures, "--body-model", captures / "body.npz"))

    def test_a_batch_leads_with_body_models(self):
        body_model(np.random.default_rng(5), self.folder / "body.npz")
        poses = np.zeros((40, 66))
        poses[:, 0], poses[:, 50] = np.pi / 2, np.linspace(0, 1, 40)
        np.savez(self.folder / "amass.npz", poses=poses, fps=30,
                 trans=np.tile([0, 0, .9], (40, 1)))
        positions = self.turning(40)
        np.save(self.folder / "positions.npy", positions)
        (self.folder / "recipe.textproto").write_text(
            'reactions { labels { weights { key: "hug" value: 1 } } }\n'
            'input { body_model: "body.npz" layout: "humanml3d" }\n'
            "output { formats: FORMAT_NPY }\n", encoding="utf-8")
        with tools.running_server() as server:
            self.duet("batch", "--server", server.address, "--recipe", "recipe.textproto",
                      "amass.npz", "positions.npy", "--out", "set")
        found = sorted(path.name for path in (self.folder / "set").glob("*.npy"))
        self.assertEqual(len(found), 2, found)

    def test_inspect_reports_the_layout_and_why(self):
        np.save(self.folder / "positions.npy", self.turning(30))
        self.assertIn("specify its layout", self.duet("inspect", "positions.npy", code=42))
        given = self.duet("inspect", "positions.npy", "--layout", "humanml3d")
        self.assertRegex(given, r"layout +humanml3d +\(given\)")
        self.convert("positions.npy", "features.npy", "--layout", "humanml3d", "--output-layout",
                     "humanml3d-263")
        guessed = self.duet("inspect", "features.npy")
        self.assertRegex(guessed, r"layout +humanml3d-263 +\(guessed: only it has 263 numbers")
        report = json.loads(self.duet("inspect", "features.npy", "--json"))
        self.assertEqual(report["files"][0]["people"][0]["layout"]["value"], "humanml3d-263")

    def test_errors_name_what_is_wrong(self):
        one = self.turning(30)
        np.save(self.folder / "pair.npy", np.stack([one, one + 1]))
        wrong = self.duet("convert", "pair.npy", "--layout", "humanml3d", "--out", "f.npy",
                          "--output-layout", "humanml3d-263", code=42)
        self.assertIn("people: expected one for layout humanml3d-263", wrong)
        self.assertIn("--output-layout: expected --out FILE.npy", self.duet(
            "convert", "pair.npy", "--layout", "humanml3d", "--out", "f.csv", "--output-layout",
            "humanml3d", code=2))
        (self.folder / "half.npz").write_bytes(b"PK\x03\x04 half an archive")
        self.assertIn("expected an .npz archive",
                      self.duet("inspect", "half.npz", "--body-model", "half.npz", code=42))


if __name__ == "__main__":
    tools.main()
