"""Pins in the studio: handles of joints, the list and links, in a real browser against a real
server."""

from studio_pages import HUG, StudioTest  # before modules that it makes available

import duet_motion as duet  # noqa: E402
import numpy as np  # noqa: E402
import tools  # noqa: E402

FRAME = 40
RIGHT_HAND = 8
REACHED = 0.01  # metres
HANDLE = """(() => {{
  const box = document.querySelector('#pin-handles [data-joint={joint}]').getBoundingClientRect();
  return [box.left + box.width / 2, box.top + box.height / 2];
}})()"""


class StudioPinsTest(StudioTest):
    def open_answered(self, address=HUG, **size):
        page = self.open_still(address, **{"width": 1200, "height": 900, **size})
        self.react(page)
        self.seek(page, FRAME)
        return page

    def handle(self, page, joint="right_hand"):
        return page.evaluate(HANDLE.format(joint=joint))

    def drag_hand(self, page, way=(20, -50)):
        start = self.handle(page)
        page.drag(start, (start[0] + way[0], start[1] + way[1]))

    def pins(self, page):
        return page.evaluate("settings.pins")

    def list_of(self, page):
        """The rows of the list: joint and frame, softness, what remains."""
        return page.evaluate("""pinHandles.rows.map(({go, softness, remains}) =>
            [go.textContent, Number(softness.value), remains.value])""")

    def test_dragged_joint_is_there_in_the_next_answer(self):
        page = self.open_answered()
        before = self.shown(page)
        page.click("#pin")
        self.drag_hand(page)
        [pin] = self.pins(page)
        self.assertEqual((pin["joint"], pin["frame"], pin["softness"]), ("right_hand", FRAME, 0))
        place = before[FRAME][RIGHT_HAND]
        self.assertGreater(np.linalg.norm(np.subtract(pin["position"], place)), 0.1)
        handle = self.handle(page)
        self.assertEqual(page.state()["stale"], "true")
        self.react(page)
        shown = self.shown(page)
        self.assertLess(np.linalg.norm(shown[FRAME][RIGHT_HAND] - pin["position"]), REACHED)
        np.testing.assert_allclose(
            shown, self.expected({"hug": 1}, constraints=[
                duet.Constraint("right_hand", FRAME, pin["position"])]), atol=1e-5)
        self.assertEqual(self.list_of(page), [[f"right hand, frame {FRAME}", 0, "reached"]])
        np.testing.assert_allclose(self.handle(page), handle, atol=1)  # it is where it was dropped

    def test_handle_follows_the_pointer_and_belongs_to_its_frame(self):
        page = self.open_answered()
        page.click("#pin")
        start = self.handle(page)
        self.drag_hand(page, (30, -40))
        np.testing.assert_allclose(self.handle(page), np.add(start, (30, -40)), atol=1.5)
        self.drag_hand(page, (-10, 5))
        self.assertEqual(len(self.pins(page)), 1)
        self.seek(page, FRAME + 1)
        page.next_frame()
        self.assertFalse(page.evaluate("Boolean(document.querySelector('#pin-handles .pinned'))"))
        self.drag_hand(page, (5, 5))
        self.assertEqual([pin["frame"] for pin in self.pins(page)], [FRAME, FRAME + 1])
        page.click("#pin")
        self.assertTrue(page.evaluate("element('pin-handles').hasAttribute('hidden')"))

    def test_list_goes_to_a_pin_softens_and_deletes(self):
        page = self.open_answered()
        page.click("#pin")
        self.drag_hand(page)
        self.seek(page, 20)
        page.evaluate("element('pin-joint').value = 'head'")
        page.click("#pin-add")
        self.assertEqual([row[0] for row in self.list_of(page)],
                         [f"right hand, frame {FRAME}", "head, frame 20"])
        for row, softness in ((0, 0.5), (1, 7)):  # the second one is not valid
            page.evaluate(f"pinHandles.rows[{row}].softness.value = {softness}")
            page.evaluate(f"pinHandles.rows[{row}].softness.dispatchEvent(new Event('change'))")
        self.assertEqual([pin["softness"] for pin in self.pins(page)], [0.5, 0])
        page.click("#pin-list li:nth-child(1) .pin-name")
        page.wait_until(f"theatre.frame === {FRAME}")
        page.click("#pin-list li:nth-child(2) button:last-child")
        self.assertEqual([pin["joint"] for pin in self.pins(page)], ["right_hand"])
        page.click("#pins-clear")
        self.assertEqual(self.pins(page), [])

    def test_pin_out_of_reach_is_reported(self):
        page = self.open_answered()
        page.evaluate("setPin(settings, 'right_hand', 40, [0, 4, 0]); changed('test')")
        self.react(page)
        self.assertIn("1 of 1 pins missed", page.text("#status"))
        self.assertRegex(self.list_of(page)[0][2], r"^\d{3} cm away$")

    def test_link_restores_pins(self):
        page = self.open_answered()
        page.click("#pin")
        self.drag_hand(page)
        page.evaluate("soften(settings, 0, 0.25); changed('test')")
        pins = self.pins(page)
        address = page.evaluate("location.hash")
        self.assertIn("pin=right_hand@40=", address)
        other = self.open_still(address, width=1200, height=900)
        self.assertEqual(self.pins(other), pins)

    def test_invalid_pins_of_links_are_ignored(self):
        page = self.open_still(HUG + "&pin=right_hand@x=1,2,3&pin=head@4=1,2&pin=head@4=1,2,nan"
                               "&pin=head@4=1,2,3,9&pin=neck@5=0,1.5,0,0.5", width=1200, height=900)
        self.assertEqual(self.pins(page), [
            {"joint": "neck", "frame": 5, "position": [0, 1.5, 0], "softness": 0.5}])
        self.react(page)
        self.assertEqual(len(page.evaluate("state.takes[0].pins")), 1)

    def test_joint_is_pinned_by_a_finger(self):
        page = self.open_answered(width=390, height=844)
        page.call("Emulation.setTouchEmulationEnabled", enabled=True)
        page.evaluate("showPins(true); scrollTo(0, 0)")
        start = self.handle(page)
        self.touch(page, start, (start[0] + 10, start[1] - 25))
        page.wait_until("settings.pins.length === 1")
        self.assertEqual(self.pins(page)[0]["joint"], "right_hand")
        self.assertLessEqual(page.evaluate("document.documentElement.scrollWidth"), 390)


if __name__ == "__main__":
    tools.main()
