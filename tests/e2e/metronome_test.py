"""The metronome of a page with a beat, in a real browser.

    metronome_test.py <write_test_page program>

Most tests replace the browser's audio clock and its frames, so that they control the time.
"""

import sys

import browser
import tools

BPM, OFFSET = 120, 0.5  # beats at 0.5, 1, 1.5, ... of 2.97 s; 0.5 and 2.5 begin a bar
RATE, FRAMES = 30, 90
END = (FRAMES - 1) / RATE
ACCENT = True

# An audio clock that stands still, and remembers every click.
FAKE_AUDIO = """
class FakeAudio {
  constructor() {
    Object.assign(this, {state: 'suspended', currentTime: 0, destination: {}, clicks: []});
    window.audio = this;
  }
  resume() { this.state = 'running'; }
  suspend() { this.state = 'suspended'; }
  createOscillator() {
    const tone = {frequency: {value: 0}, stop() {}};
    tone.connect = (volume) => { tone.volume = volume; };
    tone.start = (at) => this.clicks.push({at, tone});
    return tone;
  }
  createGain() {
    const volume = {gain: {setValueAtTime() {}, exponentialRampToValueAtTime() {}}};
    volume.connect = () => { volume.connected = true; };
    volume.disconnect = () => { volume.connected = false; };
    return volume;
  }
}
window.AudioContext = FakeAudio;
window.scene = document.getElementById('stage');
start();
cancelAnimationFrame(scene.ticking);
scene.stage.draw = () => 0;  // nobody looks
root.dataset.state = 'ready';

// Shows frames for some seconds, as the browser does.
window.watch = (seconds, step = 1 / 64) => {
  for (let passed = 0; passed < seconds - step / 2; passed += step) {
    if (window.audio) audio.currentTime += step;
    scene.tick(step);
  }
};
// Starts to play at a time of the motion, with the audio clock at 0.
window.playFrom = (seconds, speed = 1, looping = true) => {
  scene.player.playing = false;
  scene.seek(seconds * scene.player.motion.frameRate);
  scene.tick(0);
  Object.assign(scene.player, {speed, looping, playing: true});
  if (window.audio) Object.assign(audio, {currentTime: 0, clicks: []});
};
// The clicks heard by now, as [time of the audio clock, whether it is the accent].
window.heard = () => audio.clicks
    .filter(({at, tone}) => tone.volume.connected && at <= audio.currentTime)
    .map(({at, tone}) => [at, tone.frequency.value > 1500]);
"""


class MetronomeTest(tools.FolderTest):
    shared = None  # see page

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "page.html"
        cls.timed = cls.write_pages(cls.file, OFFSET)
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)

    @staticmethod
    def write_pages(file, offset):
        """Writes a page with a beat. Returns a copy of it with the clock that tests control."""
        tools.run(WRITE_TEST_PAGE, file, str(BPM), str(offset)).check_returncode()
        html = file.read_text(encoding="utf-8")
        assert "\nstart();\n" in html
        timed = file.with_suffix(".timed.html")
        timed.write_text(html.replace("\nstart();\n", FAKE_AUDIO), encoding="utf-8")
        return timed

    def open(self, file, suffix="#paused", **options):
        page = self.browser.open(file.as_uri() + suffix, **options)
        self.addCleanup(page.close)
        self.assertEqual(page.state()["state"], "ready", page.state())
        return page

    def page(self):
        """A page with a fake clock whose metronome is on; tests share it."""
        if not MetronomeTest.shared:
            MetronomeTest.shared = self.browser.open(self.timed.as_uri() + "#paused")
            MetronomeTest.shared.press("b")
        return MetronomeTest.shared

    def assert_heard(self, page, expected):
        heard = page.evaluate("heard()")
        self.assertEqual([accent for _, accent in heard], [accent for _, accent in expected], heard)
        for (at, _), (expected_at, _) in zip(heard, expected):
            self.assertAlmostEqual(at, expected_at, delta=0.001)

    def test_clicks_on_every_beat_with_accents_on_bars(self):
        page = self.page()
        page.evaluate("playFrom(0); watch(2.7)")
        self.assert_heard(page, [(0.5, ACCENT), (1, False), (1.5, False), (2, False),
                                 (2.5, ACCENT)])

    def test_clicks_when_playing_starts_on_a_beat(self):
        page = self.page()
        page.evaluate("playFrom(1); watch(0.125)")
        self.assert_heard(page, [(1 / 64, False)])  # on the first frame

    def test_slow_motion_has_slow_beats(self):
        page = self.page()
        page.evaluate("playFrom(0, 0.5); watch(2.5)")
        self.assert_heard(page, [(1, ACCENT), (2, False)])

    def test_another_speed_moves_the_next_click(self):
        page = self.page()
        page.evaluate("playFrom(0); watch(0.375); scene.player.speed = 0.25; watch(1)")
        self.assert_heard(page, [(0.375 + 4 * 0.125, ACCENT)])

    def test_loop_begins_the_beat_again(self):
        page = self.page()
        page.evaluate("playFrom(2.25); watch(1.5)")
        self.assert_heard(page, [(0.25, ACCENT), (END - 2.25 + 0.5, ACCENT)])

    def test_beats_end_with_the_motion(self):
        # The first beat is on the first frame, which follows the last one in a loop.
        page = self.open(self.write_pages(self.folder / "on_first.html", 0))
        page.press("b")
        page.evaluate("playFrom(2.25, 1, true); watch(1)")
        self.assert_heard(page, [(0.25, False), (END - 2.25, ACCENT)])
        page.evaluate("playFrom(2.25, 1, false); watch(1)")
        self.assert_heard(page, [(0.25, False)])

    def test_pause_silences_the_next_click(self):
        page = self.page()
        page.evaluate("playFrom(0); watch(0.375)")
        self.assertEqual(page.evaluate("audio.clicks.length"), 1)  # placed ahead of time
        page.evaluate("scene.toggle(); watch(1)")
        self.assert_heard(page, [])
        page.evaluate("scene.toggle(); watch(0.25)")
        self.assert_heard(page, [(1.375 + 0.125, ACCENT)])

    def test_scrubbing_is_silent_and_moves_the_beat(self):
        page = self.page()
        page.evaluate("playFrom(0); watch(0.375)")
        page.evaluate("scene.player.step(0); scene.seek(54); watch(1)")  # 1.8 s
        self.assert_heard(page, [])
        page.evaluate("scene.toggle(); watch(0.25)")
        self.assert_heard(page, [(1.375 + 0.2, False)])

    def test_late_frame_does_not_repeat_a_click(self):
        page = self.page()
        page.evaluate("playFrom(0); watch(0.453125)")
        # The motion advances by less than the time that has passed, as after a slow frame.
        page.evaluate("audio.currentTime += 0.15; scene.tick(0.03); watch(0.25)")
        self.assert_heard(page, [(0.5, ACCENT)])

    def test_button_turns_the_sound_off(self):
        page = self.open(self.timed, width=1000, height=640)
        page.click("#metronome")
        self.assertEqual(page.evaluate("audio.state"), "running")
        page.evaluate("playFrom(0); watch(0.375)")
        page.click("#metronome")
        self.assertEqual(page.evaluate("audio.state"), "suspended")
        self.assertTrue(page.evaluate("document.getElementById('metronome')"
                                      ".getAttribute('aria-pressed') === 'false'"))
        page.evaluate("watch(1)")
        self.assert_heard(page, [])

    def test_sound_is_off_until_the_button_is_pressed(self):
        page = self.open(self.timed)
        page.evaluate("playFrom(0); watch(2)")
        self.assertFalse(page.evaluate("'audio' in window"))

    def test_real_audio_clicks_after_a_click_on_the_button(self):
        page = self.open(self.file, "", width=1000, height=640)
        page.evaluate("(() => { const start = OscillatorNode.prototype.start; window.clicks = 0;"
                      " OscillatorNode.prototype.start = function(at) {"
                      " window.clicks += 1; return start.call(this, at); }; })()")
        page.click("#metronome")
        page.wait_until("window.clicks >= 2")
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])
        self.assertNotIn("error", page.state())
        urls = [event["request"]["url"] for event in page.events("Network.requestWillBeSent")]
        self.assertEqual(urls, [self.file.as_uri()])

    LIT = "[...document.querySelectorAll('#beats i')].map((dot) => dot.classList.contains('now'))"
    FLASH = "document.getElementById('beats').style.getPropertyValue('--flash')"

    def test_beat_flashes_at_its_place_in_the_bar(self):
        page = self.open(self.file)
        self.assertEqual(page.text("#bpm"), "120 BPM")
        for seconds, place, flash in ((0.2, None, None), (0.5, 0, "1.000"), (0.9, 0, "0.000"),
                                      (1, 1, "1.000"), (2, 3, "1.000"), (2.5, 0, "1.000")):
            page.evaluate(f"document.getElementById('stage').seek({seconds * RATE})")
            page.next_frame()
            self.assertEqual(page.evaluate(self.LIT), [place == i for i in range(4)], seconds)
            if flash:
                self.assertEqual(page.evaluate(self.FLASH), flash, seconds)

    def test_beat_does_not_flash_for_those_who_prefer_reduced_motion(self):
        look = "(() => { const {opacity, boxShadow} = getComputedStyle(document.querySelector(" \
               "'#beats .now')); return [opacity, boxShadow]; })()"
        looks = {}
        for still in (False, True):
            page = self.open(self.file, f"#frame={int(0.9 * RATE)}&paused", still=still)
            looks[still] = page.evaluate(look)
        self.assertEqual(looks[True], ["1", "none"])
        self.assertEqual(looks[False][0], "0.5")

    def test_page_without_a_beat_has_no_metronome(self):
        file = self.folder / "silent.html"
        tools.run(WRITE_TEST_PAGE, file).check_returncode()
        page = self.open(file)
        self.assertTrue(page.evaluate("document.getElementById('beat').hidden"))
        self.assertFalse(page.evaluate("document.getElementById('metronome').checkVisibility()"))
        page.evaluate("window.AudioContext = class { constructor() { window.opened = true; } }")
        page.press("b")
        self.assertFalse(page.evaluate("Boolean(window.opened)"))


WRITE_TEST_PAGE = sys.argv.pop(1)

if __name__ == "__main__":
    browser.find_chromium()
    tools.main()
