"""A small data set of two puppets, made as a user would: key frames become BVH files (duet-keyframe), pairs
of these a data set (duet-import). The one who leads does what a sample does; the other stands before it
and does what another sample does."""

import tools

# What each class's follower does.
ANSWERS = {"kick": "push", "push": "kick", "shake_hands": "shake_hands"}
SUBJECTS = ("ann", "bo", "cy")
APART = 1.1  # metres, as the samples mean it

POSITIONS = ("torso", "left_foot", "right_foot")
REACHES = ("left_hand", "right_hand")  # from the neck
TURNS = ("pelvis", "chest", "head")


def key_frames(name, size, faces_back):
    """The lines of a sample's key frames, for a puppet whose gestures are `size` times as wide and that
    stands where the sample's partner would, if it faces back."""
    lines = []
    for line in (tools.SOURCE / f"samples/keyframes/{name}.txt").read_text().splitlines():
        track, *values = line.split() or [""]
        if track in POSITIONS + REACHES + TURNS:
            x, y, z = map(float, values)
            if track in REACHES:
                x, z = size * x, size * z
            if faces_back:
                if track in TURNS:
                    x += 180
                else:
                    x, z = -x, (APART if track in POSITIONS else 0) - z
            line = f"  {track} {x:.4f} {y:.4f} {z:.4f}"
        lines.append(line)
        # A track without a key at the start would face forwards.
        if line == "at 0" and faces_back:
            lines += [f"  {turn} 180 0 0" for turn in TURNS]
    return unique_tracks(lines)


def unique_tracks(lines):
    """Of several values for one track at one time the last."""
    kept = []
    for line in lines:
        track = line.split()[0] if line.startswith("  ") else None
        if track:
            start = max(i for i, other in enumerate(kept) if other.startswith("at "))
            kept[start:] = [other for other in kept[start:] if other.split()[:1] != [track]]
        kept.append(line)
    return "\n".join(kept) + "\n"


def make_data_set(folder, takes=2):
    """Writes the data set `folder`/studio; returns its path."""
    captures = folder / "captures"
    captures.mkdir()
    rows = ["leader\tfollower\tlabel\tsubjects"]
    for number, subject in enumerate(SUBJECTS):
        for take in range(takes):
            size = 1 + 0.04 * number + 0.02 * take
            for label, answer in ANSWERS.items():
                files = []
                for name, faces_back in ((label, False), (answer, True)):
                    file = captures / f"{subject}_{take}_{label}_{len(files)}.txt"
                    file.write_text(key_frames(name, size, faces_back))
                    run("duet-keyframe", file, "--out", file.with_suffix(".bvh"))
                    files.append(file.with_suffix(".bvh").name)
                rows.append("\t".join([*files, label, subject]))
    (captures / "pairs.tsv").write_text("\n".join(rows) + "\n")
    run("duet-import", "--from", captures, "--out", folder / "studio")
    return folder / "studio"


def run(program, *words):
    result = tools.run(tools.PROGRAMS / program, *words)
    assert result.returncode == 0, f"{program}: {result.stdout}{result.stderr}"
