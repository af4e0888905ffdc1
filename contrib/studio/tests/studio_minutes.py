"""What an animator does in the first ten minutes, in the studio, by real mouse and keys.

    DUET_SOURCE_DIR=$PWD DUET_BIN_DIR=$PWD/build/release/bin python3 -B contrib/studio/tests/studio_minutes.py

Starts a server, a gateway and a browser, and prints a table. The list is that of
contrib/studio/guide.md. An action is a click, a drag or a key. The seconds are those
of the machine, from the first action of a step until its result is on the screen; a person adds the time
for reading and aiming.
"""

import collections
import json
import time

import gateways
import tools
from browser import Browser

Step = collections.namedtuple("Step", "name actions seconds")

CENTRE = """(() => {{
  const item = document.querySelector({selector});
  item.scrollIntoView({{block: 'nearest'}});
  const box = item.getBoundingClientRect();
  return [box.left + box.width / 2, box.top + box.height / 2];
}})()"""
LANE = """(() => {{
  const lane = timeline.laneOf({name});
  lane.svg.scrollIntoView({{block: 'nearest'}});
  const box = lane.svg.getBoundingClientRect();
  return [box.left + lane.x({frame}), box.top + lane.y({weight})];
}})()"""


class Animator:
    """Real input on a page, counted."""

    def __init__(self, page):
        self.page = page
        self.actions = 0

    def at(self, selector):
        return self.page.evaluate(CENTRE.format(selector=json.dumps(selector)))

    def click(self, selector):
        self.at(selector)
        self.page.click(selector)
        self.actions += 1

    def click_text(self, text):
        self.page.evaluate(f"""[...document.querySelectorAll('button')].find(
            (item) => item.textContent === {json.dumps(text)}).dataset.wanted = 'true'""")
        self.click("[data-wanted]")
        self.page.evaluate("delete document.querySelector('[data-wanted]').dataset.wanted")

    def drag(self, start, end):
        self.page.drag(start, end)
        self.actions += 1

    def key(self, key, modifiers=0):
        for kind in ("keyDown", "keyUp"):
            self.page.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers)
        self.actions += 1

    def lane(self, name, frame, weight):
        return self.page.evaluate(LANE.format(name=json.dumps(name), frame=frame, weight=weight))

    def answered(self, answers):
        self.page.wait_until(f"Number(document.documentElement.dataset.answers) === {answers} || "
                             "document.documentElement.dataset.failed === 'true'")
        assert self.page.state()["failed"] == "false", self.page.text("#status")
        self.page.next_frame()


def open_motion(me):
    me.click_text("hug")
    me.page.wait_until("state.leader && theatre.draws > 0")


def look(me):
    x, y = me.at("#stage")
    me.drag((x, y), (x + 120, y - 10))  # orbit
    me.key(" ")
    me.page.wait_until("theatre.player.frame > 0")
    me.key(" ")


def first_reaction(me):
    me.click("#react")
    me.answered(1)


def choose_take(me):
    me.key("e")
    me.answered(2)
    me.key("3")
    me.page.wait_until("gallery.tiles[2].getAttribute('aria-pressed') === 'true'")


def change_over_time(me):
    me.click("#curves summary")
    me.page.wait_until("element('curves').open && timeline.lanes[0].width > 0")
    for name, frame, weight in (("hug", 0, 1), ("hug", 60, 0), ("push", 45, 0), ("push", 70, 1)):
        start = me.lane(name, frame, weight)
        me.drag(start, start)
    me.key("r")
    me.answered(3)
    me.click("#curves summary")


def place(me):
    me.key("p")
    ring = me.at("#start-marker .ring")
    me.drag(ring, (ring[0] + 50, ring[1] + 15))
    knob = me.at("#start-marker .knob")
    me.drag(knob, (knob[0], knob[1] + 40))
    me.key("r")
    me.answered(4)
    assert me.page.evaluate("settings.start !== '' && settings.turn !== ''")
    me.key("p")


def pin_a_hand(me):
    me.page.evaluate("seekAll(60)")
    me.page.wait_until("theatre.frame === 60")
    me.key("j")
    hand = me.at("[data-joint=right_hand]")
    me.drag(hand, (hand[0] + 15, hand[1] - 40))
    me.key("r")
    me.answered(5)
    assert me.page.evaluate("state.takes[0].pins.length === 1 && state.takes[0].pins[0].metres < 0.4")
    me.key("j")


def undo_and_redo(me):
    me.key("z", 2)
    me.page.wait_until("state.takes[0].pins.length === 0")
    me.key("y", 2)
    me.page.wait_until("state.takes[0].pins.length === 1")


def on_character(me):
    me.click("#rig summary")
    me.click("#rig-download")
    me.page.wait_until("/follower\\.bvh$/.test(document.documentElement.dataset.downloaded) || "
                       "document.documentElement.dataset.failed === 'true'")
    assert me.page.state()["failed"] == "false", me.page.text("#status")


def export(me):
    me.click_text("GLB")
    me.page.wait_until("/\\.glb$/.test(document.documentElement.dataset.downloaded)")


STEPS = (("Open a motion", open_motion), ("Look at it: orbit, play, pause", look),
         ("Get a first reaction", first_reaction), ("Choose among eight answers", choose_take),
         ("Change the reaction over time", change_over_time), ("Place and turn the character", place),
         ("Put a hand on a spot", pin_a_hand),
         ("Undo and redo", undo_and_redo),
         ("Put it on a character", on_character), ("Export for an engine", export))


def run(page):
    """Does all steps; a list of Step."""
    steps = []
    for name, act in STEPS:
        me = Animator(page)
        begun = time.monotonic()
        act(me)
        steps.append(Step(name, me.actions, time.monotonic() - begun))
    return steps


def main():
    server = tools.Server()
    gateway = gateways.Gateway(server.address)
    browser = Browser()
    try:
        browser.forget()
        steps = run(browser.open(gateway.url, width=1440, height=900, still=True))
    finally:
        browser.close()
        gateway.stop()
        server.stop()
    print("| step | actions | seconds |\n|---|---|---|")
    for step in steps:
        print(f"| {step.name} | {step.actions} | {step.seconds:.1f} |")
    print(f"| all | {sum(step.actions for step in steps)} | {sum(step.seconds for step in steps):.1f} |")


if __name__ == "__main__":
    main()
