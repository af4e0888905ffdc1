"""A section with one of everything, for the tests."""


def latent_plot():
    """Two groups of ten points far apart."""
    return {"kind": "latent", "title": "ours", "class_names": ["kick", "hug"],
            "classes": [0] * 10 + [1] * 10, "perplexity": 30, "seed": 1,
            "features": [[float(i % 10), 0.0 if i < 10 else 100.0, 1.0] for i in range(20)]}


def pose_plot(frames=12):
    """Two people of three joints who face each other along z; the follower walks away."""
    leader = [[[0, 1, 0], [0, 1.6, 0], [-0.2, 0.5, 0]] for _ in range(frames)]
    follower = [[[x, y, 2 + 0.1 * t] for x, y, _ in pose] for t, pose in enumerate(leader)]
    return {"kind": "poses", "title": "kick", "frame_rate_hz": 15, "root": 0, "head": 1,
            "bones": [{"parent": 0, "child": 1, "side": "middle"},
                      {"parent": 0, "child": 2, "side": "left"}],
            "pairs": [{"name": "captured", "leader": leader, "follower": follower},
                      {"name": "ours", "leader": leader, "follower": follower}]}


def section(section_id="10_folds"):
    return {
        "format_version": 1, "id": section_id, "title": "Methods & classes",
        "text": ["First <paragraph>.", "Second one."],
        "tables": [{
            "title": "Errors <raw> & all", "columns": ["kick", "shake_hands"],
            "rows": [{"name": "ours", "printed": False, "values": [0.504, 1 / 3]},
                     {"name": "paper", "printed": True, "values": [0.1, 0.2]},
                     {"name": "frozen_first_frame", "printed": False, "values": [0.7, None]}],
            "notes": ["lower is better"], "decimals": 3, "best": "lowest"}],
        "figures": [{"name": section_id + "_curve", "caption": "A curve of \"errors\".",
                     "plot": pose_plot()}],
        "settings": [{"name": "data", "value": "SBU"}, {"name": "seeds", "value": "1, 2"}],
        "command": "duet-eval folds --data DIR", "date": "2024-02-29"}
