"""Holds the rig files of the project against the JSON Schema, and broken ones too: those it must refuse.

Usage: check_rig_schema.py SCHEMA RIG... Ends with 77 when python3-jsonschema is not installed."""

import copy
import sys

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"SKIPPED: {missing}; install python3-jsonschema and python3-yaml to check the rig files")
    sys.exit(77)

import json

MATRIX = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def edit(path, value):
    """An edit of a rig that sets the entry at this path."""

    def apply(rig):
        for key in path[:-1]:
            rig = rig[key]
        rig[path[-1]] = value

    return apply


def drop(path):
    """An edit of a rig that removes the entry at this path."""

    def apply(rig):
        for key in path[:-1]:
            rig = rig[key]
        del rig[path[-1]]

    return apply


PAIR = ("pairs", 0)
LEFT = PAIR + ("left",)
WISH = PAIR + ("rectify_to",)
IMAGES = PAIR + ("rectified",)

# Of a rig of raw pairs.
GOOD_RAW = [
    edit(PAIR + ("T_body_camera",), MATRIX),
    edit(PAIR + ("T_body_camera",), sum(MATRIX, [])),
    edit(PAIR + ("masks_px",), [[0, 0, 10, 10]]),
    edit(("T_body_imu",), MATRIX),
    edit(LEFT + ("distortion",), [0.1, 0, 0, 0, 0.1]),
    edit(WISH, {"model": "spherical"}),
    edit(WISH, {"model": "pinhole", "hfov_deg": 60, "vfov_deg": 40, "size_px": [640, 480]}),
]
BAD_RAW = [
    drop(("rig",)),
    drop(("pairs",)),
    edit(("pairs",), []),
    edit(("pairs",), {}),
    edit(("surplus",), 1),
    edit(("rig",), 3),
    edit(("T_body_imu",), MATRIX[:3]),
    drop(PAIR + ("name",)),
    drop(PAIR + ("left",)),
    drop(PAIR + ("right",)),
    drop(PAIR + ("T_right_left",)),
    drop(PAIR + ("rectify_to",)),
    drop(PAIR + ("T_body_camera",)),
    edit(PAIR + ("name",), "a/b"),
    edit(PAIR + ("name",), ".hidden"),
    edit(PAIR + ("name",), ""),
    edit(PAIR + ("surplus",), 1),
    edit(PAIR + ("downscale",), 0),
    edit(PAIR + ("downscale",), 17),
    edit(PAIR + ("downscale",), 1.5),
    edit(PAIR + ("rcrop_px",), -1),
    edit(PAIR + ("masks_px",), [[0, 0, 10]]),
    edit(PAIR + ("masks_px",), [0, 0, 10, 10]),
    edit(PAIR + ("min_range_m",), 0),
    edit(PAIR + ("max_range_m",), "far"),
    edit(PAIR + ("line_time_s",), -1e-5),
    edit(PAIR + ("T_right_left",), MATRIX[:3]),
    edit(PAIR + ("T_right_left",), sum(MATRIX, [])[:15]),
    edit(PAIR + ("T_right_left",), {"yaw_deg": 1}),
    edit(PAIR + ("T_right_left",), {"position_m": [0, 0]}),
    edit(PAIR + ("T_right_left",), {"position_m": [0, 0, 0], "yaw": 1}),
    drop(LEFT + ("size_px",)),
    drop(LEFT + ("lens",)),
    drop(LEFT + ("intrinsics_px",)),
    edit(LEFT + ("surplus",), 1),
    edit(LEFT + ("size_px",), [0, 480]),
    edit(LEFT + ("size_px",), [20000, 480]),
    edit(LEFT + ("size_px",), [640]),
    edit(LEFT + ("lens",), "radtan"),
    edit(LEFT + ("intrinsics_px",), [400, 400, 320]),
    edit(LEFT + ("distortion",), [0.1]),
    edit(LEFT, {"size_px": [640, 480], "lens": "kannala-brandt", "intrinsics_px": [1, 1, 1, 1]}),
    edit(LEFT, {"size_px": [640, 480], "lens": "kannala-brandt", "intrinsics_px": [1, 1, 1, 1], "distortion": [1, 2, 3]}),
    edit(LEFT, {"size_px": [640, 480], "lens": "double-sphere", "intrinsics_px": [1, 1, 1, 1], "distortion": [1, 2, 3]}),
    edit(LEFT, {"size_px": [640, 480], "lens": "radial-tangential", "intrinsics_px": [1, 1, 1, 1], "distortion": [1, 2, 3]}),
    drop(WISH + ("model",)),
    edit(WISH + ("model",), "fisheye"),
    edit(WISH + ("hfov_deg",), 0),
    edit(WISH + ("hfov_deg",), 185),
    edit(WISH + ("vfov_deg",), 341),
    edit(WISH + ("surplus",), 1),
    edit(IMAGES, {}),
]

# Of a rig of a rectified pinhole pair.
GOOD_RECTIFIED = [
    edit(IMAGES + ("disparity_offset_px",), -1.5),
    edit(
        IMAGES,
        {
            "model": "spherical",
            "size_px": [640, 480],
            "delta_theta_rad": [0.004, 0.004],
            "principal_point_px": [319.5, 239.5],
            "baseline_m": 0.1,
        },
    ),
]
BAD_RECTIFIED = [
    drop(IMAGES + ("model",)),
    drop(IMAGES + ("size_px",)),
    drop(IMAGES + ("focal_px",)),
    drop(IMAGES + ("principal_point_px",)),
    drop(IMAGES + ("baseline_m",)),
    edit(IMAGES + ("model",), "spherical"),
    edit(IMAGES + ("delta_theta_rad",), [0.004, 0.004]),
    edit(IMAGES + ("focal_px",), 0),
    edit(IMAGES + ("baseline_m",), 0),
    edit(IMAGES + ("baseline_m",), -0.1),
    edit(IMAGES + ("principal_point_px",), [1, 2, 3]),
    edit(IMAGES + ("surplus",), 1),
    edit(LEFT, {}),
    edit(WISH, {"model": "pinhole"}),
]


def main(schema_file, rig_files):
    with open(schema_file, encoding="utf-8") as stream:
        schema = json.load(stream)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    rigs = {}
    for file in rig_files:
        with open(file, encoding="utf-8") as stream:
            rigs[file] = yaml.safe_load(stream)
    complaints = []

    def expect(good, rig, what):
        if validator.is_valid(rig) != good:
            message = jsonschema.exceptions.best_match(validator.iter_errors(rig)) if good else "is taken"
            complaints.append(f"{what}: {getattr(message, 'message', message)}")

    def edited(rig, apply):
        copied = copy.deepcopy(rig)
        apply(copied)
        return copied

    for file, rig in rigs.items():
        expect(True, rig, file)
    raw = next(rig for rig in rigs.values() if "left" in rig["pairs"][0])
    rectified = next(rig for rig in rigs.values() if "rectified" in rig["pairs"][0])
    checked = len(rigs)
    for rig, good, edits in (
        (raw, True, GOOD_RAW),
        (raw, False, BAD_RAW),
        (rectified, True, GOOD_RECTIFIED),
        (rectified, False, BAD_RECTIFIED),
    ):
        for number, apply in enumerate(edits):
            kind = ("good" if good else "broken") + (" raw" if rig is raw else " rectified")
            expect(good, edited(rig, apply), f"{kind} rig, edit {number + 1}")
            checked += 1
    for complaint in complaints:
        print(complaint)
    print(f"{checked} rigs checked, {len(complaints)} complaints")
    return 1 if complaints or not rigs else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
