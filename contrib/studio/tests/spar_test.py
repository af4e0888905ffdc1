"""The Spar page of contrib/studio in a real browser, through the gateway, against a real server."""

import json

from studio_pages import PageTest  # before modules that it makes available

import numpy as np  # noqa: E402
import tools  # noqa: E402

# From then on, the page's time passes only with PASS. Frames are sent as usual.
FREEZE = "window.pass = advance; advance = () => {}; undefined"
PASS = "(() => {{ for (let i = 0; i < {steps}; ++i) pass(1 / 60); }})()"
POSE = "Array.from(spar.leader.pose)"


class SparTest(PageTest):
    def open(self, query="", width=420, height=420, frozen=False):
        page = self.browser.open(f"{self.gateway.url}/spar{query}", width=width, height=height)
        self.addCleanup(page.close)
        self.assertEqual(page.state()["state"], "ready", page.text("#away"))
        page.wait_until("spar.seen")
        if frozen:
            page.evaluate(FREEZE)
        return page

    def pass_time(self, page, seconds):
        page.evaluate(PASS.format(steps=round(60 * seconds)))

    def pose(self, page):
        return np.reshape(page.evaluate(POSE), (-1, 3))

    def weights(self, page):
        return {name: weight for name, weight in page.evaluate("spar.weights").items() if weight}

    def test_follower_answers_without_errors(self):
        page = self.open()
        page.wait_until("document.documentElement.dataset.frames > 30")
        shown = np.reshape(page.evaluate("Array.from(stage.motion.people.follower)"), (15, 3))
        distance = np.linalg.norm((shown - self.pose(page)).mean(axis=0)[[0, 2]])
        self.assertTrue(0.15 < distance < 3, distance)
        page.wait_until("/Half within \\d+ ms/.test(element('figures').textContent)")
        self.assertTrue(page.evaluate("element('away').hidden"))
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])
        self.assertEqual([event for event in page.events("Runtime.consoleAPICalled")
                          if event["type"] == "error"], [])
        for url in (event["request"]["url"] for event in page.events("Network.requestWillBeSent")):
            self.assertTrue(url.startswith((self.gateway.url, "data:", "blob:")), url)

    def test_both_people_are_visible(self):
        page = self.open(width=1000, height=700)
        page.wait_until("document.documentElement.dataset.frames > 20")
        picture = page.picture()
        area = {"left": 0, "right": 0.6, "top": 0.05, "bottom": 0.8}
        self.assertGreater(picture.count(tools.is_leader_orange, **area), 1000)
        self.assertGreater(picture.count(tools.is_follower_teal, **area), 1000)

    def test_keys_throw_moves_that_begin_and_end_blended(self):
        page = self.open(frozen=True)
        classes = page.evaluate("spar.model.interaction_classes")
        for key, name in enumerate(classes, 1):
            with self.subTest(name):
                page.press(str(key))
                self.assertEqual(page.state()["move"], name)
                self.assertEqual(self.weights(page), {name: 1})
                fastest = page.evaluate("""(() => {
                  let [before, most] = [Array.from(spar.leader.pose), 0];
                  for (let i = 0; i < 240; ++i) {
                    pass(1 / 60);
                    const now = Array.from(spar.leader.pose);
                    most = Math.max(most, ...now.map((value, k) => Math.abs(value - before[k])));
                    before = now;
                  }
                  return 60 * most;
                })()""")
                self.assertTrue(0.3 < fastest < 12, fastest)  # metres a second
                self.assertEqual(page.state()["move"], "")

    def test_leader_steps_back_before_a_blow_that_would_go_through_the_partner(self):
        page = self.open(frozen=True)
        page.evaluate("""(() => {
          spar.partner = placed(spar.leader.pose, {x: 0, z: 0.95, yaw: Math.PI});
          showFollower = () => {};
        })()""")
        begun = "spar.leader.clip !== null"
        room = "distance(spar.body, spar.leader.pose, spar.partner) - spar.leader.clip.reach"
        page.press("4")  # a hug comes as near as it likes
        self.assertTrue(page.evaluate(begun))
        self.pass_time(page, 6)
        page.press("1")
        self.assertEqual((page.state()["move"], page.evaluate(begun)), ("kick", False))
        self.pass_time(page, 0.9)
        self.assertTrue(page.evaluate(begun))
        self.assertGreater(page.evaluate(room), 0.1)
        # A step of the visitor's own ends it.
        self.pass_time(page, 6)
        page.evaluate("spar.partner = placed(spar.leader.pose, {...spar.leader.root, z: spar.leader.root.z + 0.5})")
        page.press("6")
        page.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowUp")
        self.assertEqual((page.state()["move"], page.evaluate("spar.leader.backs")), ("", False))

    def test_nothing_is_asked_for_until_a_move_and_after_it(self):
        page = self.open(frozen=True)
        self.assertEqual(self.weights(page), {})
        page.evaluate("""(() => {
          window.sent = [];
          const send = spar.session.send.bind(spar.session);
          spar.session.send = (message) => { window.sent.push(message); send(message); };
        })()""")
        page.press("1")
        self.assertEqual(self.weights(page), {"kick": 1})
        self.pass_time(page, 6)
        self.assertEqual((page.state()["move"], self.weights(page)), ("", {}))
        eases = page.evaluate("window.sent.filter((message) => message.label_change).map("
                              "(message) => message.label_change.ease_frames)")
        self.assertEqual(eases, [9, 30])
        # What the visitor sets by hand stays.
        page.press("1")
        page.evaluate("""(() => {
          const slider = document.querySelector('#labels input[name=hug]');
          slider.value = 0.5;
          slider.dispatchEvent(new Event('input', {bubbles: true}));
        })()""")
        self.pass_time(page, 6)
        self.assertEqual(self.weights(page), {"kick": 1, "hug": 0.5})

    def test_partner_stands_there_before_the_server_answers(self):
        page = self.open(width=1000, height=700)
        page.evaluate("""(async () => {
          window.WebSocket = class extends EventTarget { close() {} };
          await chooseModel(spar.model);
        })()""")
        page.next_frame()
        picture = page.picture()
        area = {"left": 0, "right": 0.6, "top": 0.05, "bottom": 0.8}
        self.assertGreater(picture.count(tools.is_follower_teal, **area), 1000)
        self.assertFalse(page.evaluate("spar.seen"))

    def test_help_is_about_fingers_on_a_phone(self):
        page = self.open(width=390, height=720)
        self.assertRegex(page.text("#help"), "^Keys 1 to 8 throw a move")
        page.call("Emulation.setDeviceMetricsOverride", width=390, height=720, deviceScaleFactor=0.5,
                  mobile=True)
        page.call("Emulation.setTouchEmulationEnabled", enabled=True)
        page.reload()
        page.wait_until("element('help').textContent")
        self.assertRegex(page.text("#help"), "^Tap a move")
        self.assertNotRegex(page.text("#help"), "[Kk]ey")

    def test_limbs_keep_their_lengths(self):
        page = self.open(frozen=True)
        stretched = page.evaluate("""(() => {
          const {leader, body, model} = spar;
          const length = (pose, {parent_joint: a = 0, child_joint: b = 0}) =>
              norm(sub(body.at(pose, a), body.at(pose, b)));
          let most = 0;
          const look = (steps) => {
            for (let i = 0; i < steps; ++i) {
              pass(1 / 60);
              for (const bone of model.bones) {
                most = Math.max(most, Math.abs(length(leader.pose, bone) / length(leader.rest, bone) - 1));
              }
            }
          };
          look(60);
          leader.wanted = {forward: 1, left: 0.5};
          look(120);
          leader.wanted = {forward: 0, left: 0};
          look(60);
          return most;
        })()""")
        self.assertLess(stretched, 0.12)

    def test_arrows_walk_and_turn(self):
        page = self.open(frozen=True)
        for key, way in (("ArrowUp", "forward"), ("ArrowDown", "back"), ("ArrowLeft", "left")):
            with self.subTest(key):
                before = page.evaluate("({...spar.leader.root})")
                page.call("Input.dispatchKeyEvent", type="keyDown", key=key)
                self.assertEqual(page.evaluate("[...spar.held]"), [way])
                self.pass_time(page, 1)
                page.call("Input.dispatchKeyEvent", type="keyUp", key=key)
                after = page.evaluate("({...spar.leader.root})")
                ahead = ((after["x"] - before["x"]) * np.sin(before["yaw"])
                         + (after["z"] - before["z"]) * np.cos(before["yaw"]))
                if way == "left":
                    self.assertGreater(after["yaw"] - before["yaw"], 1)
                else:
                    self.assertTrue(0.5 < ahead * (1 if way == "forward" else -1) < 4, ahead)
                self.pass_time(page, 1)

    def test_sliders_change_the_labels(self):
        page = self.open()
        page.evaluate("""(() => {
          window.sent = [];
          const send = spar.session.send.bind(spar.session);
          spar.session.send = (message) => { window.sent.push(message); send(message); };
          const slider = document.querySelector('#labels input[name=hug]');
          slider.value = 0.5;
          slider.dispatchEvent(new Event('input', {bubbles: true}));
        })()""")
        change = page.evaluate("window.sent.find((message) => message.label_change).label_change")
        self.assertEqual(change["ease_frames"], 9)
        weights = {one["interaction_class"]: one["weight"]
                   for one in change["label_vector"]["weights"]}
        self.assertEqual(weights["hug"], 0.5)
        page.evaluate("element('follow').click()")
        page.press("1")
        self.assertEqual(self.weights(page)["hug"], 0.5)

    def test_server_that_goes_is_announced_and_its_return_resumes(self):
        page = self.open()
        page.wait_until("document.documentElement.dataset.frames > 30")
        self.server.kill()
        page.wait_until("!element('away').hidden")
        self.assertIn("The server is away", page.text("#away"))
        type(self).server = tools.Server(port=self.port)
        page.wait_until("element('away').hidden")
        page.wait_until("spar.latencies.counts.resumed > 0")
        before = int(page.state()["frames"])
        page.wait_until(f"Number(document.documentElement.dataset.frames) > {before + 10}")

    def test_short_interruption_loses_no_frame(self):
        page = self.open()
        page.wait_until("document.documentElement.dataset.frames > 30")
        page.evaluate("window.started = spar.session.leader; spar.session.socket.close()")
        end = page.evaluate("spar.session.follower.end")
        page.wait_until(f"spar.latencies.counts.resumed > 0 && spar.session.follower.end > {end + 10}")
        self.assertTrue(page.evaluate("spar.session.leader === window.started"))

    def test_socket_that_opens_late_begins_a_new_session(self):
        page = self.open()
        page.wait_until("document.documentElement.dataset.frames > 30")
        page.evaluate("""(() => {
          const {session} = spar;
          const connect = session.connect.bind(session);
          session.connect = () => {
            connect();
            const pose = session.leader.get(session.leader.end - 1);
            session.add(Array(90).fill(pose), performance.now() / 1000);
            session.connect = connect;
          };
          window.stale = session.leader;
          session.socket.close();
        })()""")
        page.wait_until("spar.latencies.counts.resumed > 0 && spar.session.follower.end > 10")
        self.assertTrue(page.evaluate("spar.session.leader !== window.stale"))
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])

    def test_models_that_answer_live_can_be_chosen(self):
        page = self.open()
        names = page.evaluate("[...element('model').options].map((option) => option.value)")
        self.assertEqual(names, ["everyday@1", "salsa@2", "sbu@3"])
        neutral = [["wave", None], ["sit", None]]
        hands = [["shake_hands", "meet_hands"], ["high_five", "meet_hands"]]
        for index, moves in enumerate(([*hands, ["pull", "pull"], ["walk", "walk"], *neutral], neutral)):
            page.evaluate(f"chooseModel(spar.models[{index}])")
            page.wait_until("spar.seen")
            self.assertEqual(page.evaluate("spar.session.settings.model"), names[index])
            self.assertEqual(page.evaluate("spar.choreography.moves.map(({leader, label}) => [leader, label])"),
                             moves)

    def test_moves_of_the_everyday_model(self):
        page = self.open("?model=everyday", frozen=True)
        for key, leader, weights in (("2", "high_five", {"meet_hands": 1}), ("5", "wave", {}),
                                     ("3", "pull", {"pull": 1})):
            page.press(key)
            self.assertEqual((page.state()["move"], self.weights(page)), (leader, weights))
        self.pass_time(page, 6)
        self.assertEqual((page.state()["move"], self.weights(page)), ("", {}))

    def test_every_control_works_on_a_phone_and_has_a_name(self):
        page = self.open(width=375, height=720, frozen=True)
        self.check_controls(page, "button, select, input[type=number]")
        page.click("#moves button:nth-child(2)")
        self.assertEqual(page.state()["move"], "push")
        box = page.evaluate("(({x, y}) => [x, y])(document.querySelector("
                            "'#steer [data-way=forward]').getBoundingClientRect())")
        page.mouse("mousePressed", box[0] + 20, box[1] + 20)
        self.assertEqual(page.evaluate("[...spar.held]"), ["forward"])
        page.mouse("mouseReleased", box[0] + 20, box[1] + 20, buttons=0)
        self.assertEqual(page.evaluate("[...spar.held]"), [])


if __name__ == "__main__":
    tools.main()
