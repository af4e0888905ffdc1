"""The studio's tools in a real browser against a real server: gallery, curves, start,
undo, rigs."""

import contextlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from studio_pages import FOLLOWER, HUG, StudioTest  # before modules that it makes available

import duet_motion as duet  # noqa: E402
import numpy as np  # noqa: E402
import studio_minutes  # noqa: E402
import tools  # noqa: E402

GUIDE = (tools.SOURCE / "contrib/studio/guide.md").read_text(encoding="utf-8")
FRAMES = 91
TORSO = 2
# The pixel of a weight at a frame in the lane of a class.
IN_LANE = """(() => {{
  const lane = timeline.laneOf({name});
  lane.svg.scrollIntoView({{block: 'center'}});
  const box = lane.svg.getBoundingClientRect();
  return [box.left + lane.x({frame}), box.top + lane.y({weight})];
}})()"""
# The pixel in the middle of an element of the start's marker.
IN_MARKER = """(() => {{
  const box = document.querySelector('#start-marker .{part}').getBoundingClientRect();
  return [box.left + box.width / 2, box.top + box.height / 2];
}})()"""
# Whether a tile shows both people.
TILE_COLOURS = """gallery.tiles.map((tile) => {
  const canvas = tile.querySelector('canvas');
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let [leader, follower] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] > 200 && data[i + 2] < 120) ++leader;
    if (data[i] < 110 && data[i + 1] > 150) ++follower;
  }
  return [leader, follower];
})"""


class ToolsTest(StudioTest):
    def in_lane(self, page, name, frame, weight):
        return page.evaluate(IN_LANE.format(name=json.dumps(name), frame=frame, weight=weight))

    def open_curves(self, page):
        page.click("#curves summary")
        page.wait_until("element('curves').open && timeline.lanes[0].width > 0")

    def choose_file(self, page, selector, path):
        document = page.call("DOM.getDocument")["root"]["nodeId"]
        node = page.call("DOM.querySelector", nodeId=document, selector=selector)["nodeId"]
        page.call("DOM.setFileInputFiles", nodeId=node, files=[str(path)])

    # Gallery.

    def test_seed_is_the_servers_until_the_visitor_types_one(self):
        page = self.open_still(HUG, width=1200, height=900)
        field = "(({value, placeholder}) => [value, placeholder])(document.querySelector('[name=seed]'))"
        self.assertEqual(page.evaluate(field), ["", "automatic"])
        self.react(page)
        first = self.default_seed()
        self.assertEqual(page.evaluate(field), ["", f"{first} (automatic)"])
        self.assertIn(f"seed {first}.", page.text("#status"))
        self.assertNotIn("seed", page.evaluate("location.hash"))
        self.set(page, "[name=seed]", first + 1)
        self.assertEqual(page.state()["stale"], "true")
        self.react(page)
        np.testing.assert_allclose(self.shown(page), self.expected({"hug": 1}, seed=first + 1), atol=1e-5)
        self.assertIn(f"seed={first + 1}", page.evaluate("location.hash"))
        # An empty field asks the server again, whose choice is as before.
        self.set(page, "[name=seed]", "")
        self.assertEqual(page.state()["stale"], "true")
        self.react(page)
        np.testing.assert_allclose(self.shown(page), self.expected({"hug": 1}), atol=1e-5)
        self.press(page, "another")
        self.assertEqual(page.evaluate("[settings.seed, state.takes[0].seed]"), [first + 1] * 2)

    def test_gallery_shows_eight_answers_with_the_best_first(self):
        page = self.open_still(HUG, width=1200, height=900)
        self.press(page, "show-eight")
        takes = page.evaluate("state.takes.map(({seed, grade}) => ({seed, grade}))")
        first = self.default_seed()
        self.assertEqual([take["seed"] for take in takes], list(range(first, first + 8)))

        def faults(take):
            grade = take["grade"]
            return (grade.get("twisted", 0) + grade.get("overlapping", 0) +
                    max(0, grade.get("skating", 0) - grade.get("leader_skating", 0)))
        order = [take["seed"] for take in sorted(takes, key=faults)]
        seeds = "gallery.tiles.map((tile) => Number(/\\d+/.exec(tile.textContent)[0]))"
        self.assertEqual(page.evaluate(seeds), order)
        self.assertEqual(page.evaluate("settings.seed"), order[0])
        for leader, follower in page.evaluate(TILE_COLOURS):
            self.assertGreater(leader, 50)
            self.assertGreater(follower, 50)

    def test_gallery_is_chosen_from_by_mouse_and_keys(self):
        page = self.open_still(HUG, width=1200, height=900)
        self.press(page, "show-eight")
        seeds = page.evaluate("gallery.tiles.map((tile) => Number(/\\d+/.exec(tile.textContent)[0]))")
        page.click("#answers .answer:nth-child(4)")
        self.assertEqual(page.evaluate("settings.seed"), seeds[3])
        np.testing.assert_allclose(self.shown(page), self.expected({"hug": 1}, seed=seeds[3]),
                                   atol=1e-5)
        np.testing.assert_allclose(  # the scene shows it, too
            np.reshape(page.evaluate("Array.from(theatre.motion.people.follower)"), (91, 15, 3)),
            self.shown(page), atol=1e-6)
        for key, place in (("1", 0), ("8", 7), ("6", 5)):
            self.key(page, key)
            self.assertEqual(page.evaluate("settings.seed"), seeds[place], key)
            self.assertTrue(page.evaluate(
                f"document.activeElement === gallery.tiles[{place}] && "
                f"document.activeElement.getAttribute('aria-pressed') === 'true'"), key)
        # Another gallery has the next seeds; the same one has the same seeds.
        self.press(page, "show-eight")
        self.assertEqual(page.evaluate("seedsOf(state.takes)"), sorted(seeds))
        self.press(page, "another")
        self.assertEqual(page.evaluate("seedsOf(state.takes)"), [seed + 8 for seed in sorted(seeds)])

    def test_failed_gallery_keeps_the_answers_of_before(self):
        page = self.open_still(HUG, width=1200, height=900)
        self.press(page, "show-eight")
        before = page.evaluate("seedsOf(state.takes)")
        shown = "Array.from(theatre.motion.people.follower)"
        follower = page.evaluate(shown)
        page.evaluate("settings.candidates = 99; react(8)")
        page.wait_until("document.documentElement.dataset.failed === 'true'")
        self.assertEqual(page.evaluate(shown), follower)
        self.assertIn("candidates", page.text("#problems"))
        self.assertEqual(page.evaluate("[seedsOf(state.takes), gallery.tiles.length]"),
                         [before, 8])

    # Curves.

    def test_curves_are_drawn_by_mouse_and_sent(self):
        page = self.open_still(HUG, width=1200, height=900)
        self.open_curves(page)
        for frame, weight in ((0, 0), (60, 1)):
            x, y = self.in_lane(page, "hug", frame, weight)
            page.mouse("mousePressed", x, y)
            page.mouse("mouseReleased", x, y, buttons=0)
        self.assertEqual(page.evaluate("settings.curves"), {"hug": [[0, 0], [60, 1]]})
        page.drag(self.in_lane(page, "hug", 60, 1), self.in_lane(page, "hug", 30, 0.5))
        self.assertEqual(page.evaluate("settings.curves"), {"hug": [[0, 0], [30, 0.5]]})
        page.drag(self.in_lane(page, "push", 80, 0.5), self.in_lane(page, "push", 90, 1))
        self.assertEqual(page.evaluate("settings.curves.push"), [[90, 1]])
        self.react(page)
        wanted = self.expected(keyframes={
            frame: {name: {"hug": hug, "push": 1}.get(name, 0) for name in tools.CLASSES}
            for frame, hug in ((0, 0), (30, 0.5), (90, 0.5))})
        np.testing.assert_allclose(self.shown(page), wanted, atol=1e-5)
        self.assertIn("curve=hug;0:0,30:0.5", page.evaluate("location.hash"))
        x, y = self.in_lane(page, "push", 90, 1)
        page.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="right",
                  buttons=2, clickCount=1)
        self.assertEqual(page.evaluate("Object.keys(settings.curves)"), ["hug"])
        self.assertEqual(page.evaluate("document.documentElement.dataset.stale"), "true")

    def test_slider_of_a_curve_sets_a_point_in_the_current_frame(self):
        page = self.open_still(HUG, width=1200, height=900)
        self.open_curves(page)
        self.seek(page, 31)
        self.label(page, "hug", 0.95)
        self.key(page, "k")
        self.assertEqual(page.evaluate("settings.curves.hug"), [[31, 0.95]])
        self.seek(page, 50)
        self.label(page, "hug", 0.25)
        self.assertEqual(page.evaluate("settings.curves.hug"), [[31, 0.95], [50, 0.25]])
        page.click("#clear-curves")
        self.assertEqual(page.evaluate("settings.curves"), {})

    def test_curves_are_drawn_by_a_finger(self):
        page = self.open_still(HUG, width=390, height=844)
        page.call("Emulation.setTouchEmulationEnabled", enabled=True)
        page.evaluate("element('curves').open = true")
        page.wait_until("timeline.lanes[0].width > 0")
        start = self.in_lane(page, "push", 40, 0)
        to = self.in_lane(page, "push", 60, 0.8)
        self.touch(page, start, to)
        page.wait_until("curveOf(settings, 'push').length === 1")
        [[frame, weight]] = page.evaluate("settings.curves.push")
        self.assertAlmostEqual(frame, 60, delta=1)
        self.assertAlmostEqual(weight, 0.8, delta=0.06)

    # The follower's start.

    def test_start_is_dragged_and_turned_in_the_scene(self):
        page = self.open_still(HUG, width=1200, height=900)
        page.click("#place")
        place = page.evaluate("startNow(state.leader).root")
        start = page.evaluate(IN_MARKER.format(part="ring"))
        page.drag(start, (start[0] + 60, start[1] + 20))
        moved = page.evaluate("numbers(settings.start)")
        self.assertGreater(np.hypot(moved[0] - place[0], moved[2] - place[2]), 0.1)
        self.react(page)
        np.testing.assert_allclose(self.shown(page)[0][TORSO], moved, atol=0.002)
        # The knob turns it; the pose is then the shown one.
        before = page.evaluate("startNow(state.leader).heading")
        knob = page.evaluate(IN_MARKER.format(part="knob"))
        aside = page.evaluate("""(() => {
          const {root: [x, y, z], heading} = startNow(state.leader);
          const [right, ahead] = [Math.sin(radians(heading + 90)), Math.cos(radians(heading + 90))];
          const box = theatre.getBoundingClientRect();
          const [left, top] = theatre.project(x + 0.55 * right, theatre.floorHeight, z + 0.55 * ahead);
          return [box.left + left, box.top + top];
        })()""")
        page.drag(knob, aside)
        after = float(page.evaluate("settings.turn"))
        self.assertAlmostEqual((after - before) % 360, 90, delta=3)
        wanted = np.reshape(page.evaluate(
            "Array.from(startMessage(state.leader.motion).pose.positions)"), (15, 3))
        self.react(page)
        np.testing.assert_allclose(self.shown(page)[0], wanted, atol=0.002)
        heading = page.evaluate("headingOf(state.leader.motion, state.takes[0].positions)")
        self.assertAlmostEqual(abs((heading - after + 180) % 360 - 180), 0, delta=3)

    def test_start_is_restored_by_a_link_and_freed(self):
        page = self.open_still(HUG, width=1200, height=900)
        before = page.evaluate("startNow(state.leader)")
        self.key(page, "p")
        start = page.evaluate(IN_MARKER.format(part="ring"))
        page.drag(start, (start[0] + 60, start[1] + 20))
        self.assertGreater(abs(page.evaluate("startNow(state.leader).root[0]") - before["root"][0]), 0.01)
        link = page.evaluate("location.hash")
        wanted = page.evaluate("[settings.start, settings.turn, settings.pose]")
        page.evaluate("element('free-start').click()")
        self.assertEqual(page.evaluate("[settings.start, settings.turn, settings.pose]"), ["", "", []])
        again = self.open_still(link)
        self.assertEqual(again.evaluate("[settings.start, settings.turn, settings.pose]"), wanted)

    # Undo.

    def test_everything_is_undone_and_redone(self):
        page = self.open_still(width=1200, height=900)
        work = "JSON.stringify([settings, state.leader?.name, seedsOf(state.takes), state.chosen])"
        states = [page.evaluate(work)]

        def did(what):
            self.assertEqual(page.evaluate("element('undo').title"), f"Undo: {what}")
            states.append(page.evaluate(work))
        page.evaluate("takeSample('hug')")
        page.wait_until("state.leader")
        did("open hug.bvh")
        page.evaluate("undoHistory.endGesture()")
        self.label(page, "push", 0.2)
        self.label(page, "push", 0.3)  # of the same gesture
        did("weight of push")
        self.press(page, "show-eight")
        did("show eight")
        page.click("#answers .answer:nth-child(3)")
        did(f"choose seed {page.evaluate('settings.seed')}")
        self.open_curves(page)
        page.drag(self.in_lane(page, "hug", 20, 0.5), self.in_lane(page, "hug", 40, 0.9))
        did("curve of hug")
        page.click("#place")
        start = page.evaluate(IN_MARKER.format(part="ring"))
        page.drag(start, (start[0] + 40, start[1] + 10))
        did("follower's start")
        self.react(page)
        did("react")
        page.evaluate("takeSample('kick')")
        page.wait_until("state.leader.name === 'kick.bvh'")
        did("open kick.bvh")
        for expected in reversed(states[:-1]):
            self.key(page, "z", modifiers=2)
            self.assertEqual(page.evaluate(work), expected)
        self.assertTrue(page.evaluate("element('undo').disabled && theatre.hidden"))
        for expected in states[1:-1]:
            self.key(page, "y", modifiers=2)
            self.assertEqual(page.evaluate(work), expected)
        self.assertEqual(page.evaluate("gallery.tiles.length"), 0)
        np.testing.assert_allclose(  # the scene shows what was redone
            page.evaluate("Array.from(theatre.motion.people.follower)"), page.evaluate(FOLLOWER),
            atol=1e-6)
        # A new change removes what was undone.
        self.key(page, "z", modifiers=2)
        self.label(page, "push", 0.1)
        self.assertTrue(page.evaluate("element('redo').disabled"))

    # Sizes.

    def test_rows_scroll_below_the_scene_on_a_low_screen(self):
        page = self.open_still(HUG, width=1440, height=800)
        self.press(page, "show-eight")
        page.evaluate("document.querySelectorAll('main details').forEach((item) => { item.open = true; })")
        scene = "element('view').getBoundingClientRect().top"
        before = page.evaluate(scene)
        x, y = page.evaluate("""(({left, top}) => [left + 5, top + 5])(
            element('gallery-title').getBoundingClientRect())""")
        page.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=900)
        page.wait_until("""(() => {
            const {left, top, width, height} = element('pin-add').getBoundingClientRect();
            return document.elementFromPoint(left + width / 2, top + height / 2) === element('pin-add');
        })()""")
        self.assertEqual(page.evaluate(scene), before)

    # Rigs.

    def test_answer_is_written_on_another_files_rig(self):
        page = self.open_still(HUG, width=1200, height=900)
        self.react(page)
        text = tools.sample("kick").read_text(encoding="utf-8").replace("JOINT left_hand",
                                                                        "JOINT Flipper")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "robot.bvh"
            path.write_text(text, encoding="utf-8")
            self.choose_file(page, "#rig-file", path)
            page.wait_until("state.rig !== null")
        self.assertEqual(page.text("#rig-name"), "robot.bvh")
        page.evaluate("attempt(downloadOnRig)()")
        self.assertIn("left_hand", page.text("#status"))
        self.set(page, "[name=rig_joint_map]", "left_hand=Flipper")
        name, written = self.saved(page, lambda: page.evaluate("attempt(downloadOnRig)()"))
        self.assertRegex(name, r"\.follower\.bvh$")
        self.assertEqual(re.findall(r"(?:ROOT|JOINT) \S+", written),
                         re.findall(r"(?:ROOT|JOINT) \S+", text))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "follower.bvh"
            path.write_text(written, encoding="utf-8")
            on_rig = duet.read_motion(path, joint_map={"left_hand": "Flipper"}).positions
        self.assertLess(np.linalg.norm(on_rig - self.shown(page), axis=2).mean(), 0.05)

    # The guide.

    def test_first_ten_minutes_of_an_animator(self):
        page = self.open_still(width=1440, height=900)
        steps = studio_minutes.run(page)
        self.assertEqual([step.name for step in steps], [name for name, _ in studio_minutes.STEPS])
        rows = [[cell.strip() for cell in row.strip("|").split("|")]
                for row in re.findall(r"^\|.*\|$", GUIDE, re.MULTILINE)]
        self.assertEqual([(row[0], int(row[-1])) for row in rows if row[-1].isdigit()],
                         [*((step.name, step.actions) for step in steps),
                          ("all", sum(step.actions for step in steps))])

    def test_first_commands_of_the_guide_start_the_studio(self):
        server, gateway = re.search(r"## Start\n\n```sh\n(.*?) &\n(.*?) +#.*\n```", GUIDE).groups()
        port, web_port = tools.free_ports(2)
        commands = (f"{server} --listen 127.0.0.1:{port} --metrics-listen off",
                    f"{gateway} --server localhost:{port} --listen 127.0.0.1:{web_port}")
        path = os.pathsep.join((str(pathlib.Path(sys.executable).parent), os.environ["PATH"]))
        with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
            (pathlib.Path(folder) / "build").mkdir()  # as in a built clone
            (pathlib.Path(folder) / "build" / "release").symlink_to(tools.PROGRAMS.parent)
            (pathlib.Path(folder) / "contrib").symlink_to(tools.SOURCE / "contrib")
            for command, ready in zip(commands, ('"serving"', "http://")):
                started = stack.enter_context(subprocess.Popen(
                    ["bash", "-c", f"exec env {command}"], cwd=folder, stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT, text=True, env={**os.environ, "PATH": path}))
                stack.callback(started.terminate)
                line = next((line for line in started.stdout if ready in line), "")
                self.assertNotEqual(line, "", f"{command} ended")
            page = self.browser.open(line.strip(), still=True)
            self.assertEqual(page.state()["state"], "ready", page.text("#status"))
            page.wait_until("state.models.length > 0")


if __name__ == "__main__":
    tools.main()
