"""The example in Python: its structures are those of C, and it writes what it says, or nothing.
   dataset_check.py ROOT LIBRARY SANITIZER CC...    77: Python itself would have to be sanitized"""
import ctypes
import ctypes.util
import inspect
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT, LIBRARY, SANITIZER, *CC = sys.argv[1:]
if SANITIZER != "none":
    print("a sanitized library cannot be loaded by this Python: skipped")
    sys.exit(77)
sys.dont_write_bytecode = True
sys.path.insert(0, f"{ROOT}/examples")
import dataset  # noqa: E402

SIZE = WIDTH, HEIGHT = 64, 48


def need(condition, what):
    if not condition:
        sys.exit(f"dataset_check.py: {what}")


def layout_of_python():
    """Lines "wd_x SIZE" and "wd_x.member OFFSET SIZE" of the example's structures."""
    for name, structure in inspect.getmembers(dataset, inspect.isclass):
        if issubclass(structure, ctypes.Structure) and structure.__module__ == "dataset":
            c_name = "wd" + re.sub("[A-Z]", lambda match: "_" + match[0].lower(), name)
            yield c_name, None, f"{c_name} {ctypes.sizeof(structure)}"
            for member, _ in structure._fields_:
                field = getattr(structure, member)
                yield c_name, member, f"{c_name}.{member} {field.offset} {field.size}"


def check_layout(scratch):
    """A program in C prints the same lines, and the same bits of layers."""
    told = list(layout_of_python())
    prints = []
    for name, member, _ in told:
        prints.append(f'printf("{name} %zu\\n", sizeof(struct {name}));' if member is None else
                      f'printf("{name}.{member} %zu %zu\\n", offsetof(struct {name}, {member}), '
                      f'sizeof(((struct {name} *)0)->{member}));')
    lines = [line for _, _, line in told]
    for name, value in vars(dataset).items():
        if name.startswith("LAYER_"):
            prints.append(f'printf("{name} %d\\n", WD_{name});')
            lines.append(f"{name} {value}")
    source = scratch / "layout.c"
    source.write_text("#include <stdio.h>\n#include <weald/renderer.h>\nint main(void)\n{\n    "
                      + "\n    ".join(prints) + "\n    return 0;\n}\n")
    program = scratch / "layout"
    subprocess.run([*CC, source, f"-I{ROOT}/include", "-o", program], check=True)
    in_c = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split("\n")
    for ours, theirs in zip(lines, in_c[:-1], strict=True):
        need(ours == theirs, f"in Python {ours}, in C {theirs}")
    print(f"{len(lines)} sizes, places and constants are those of C")


def run(*arguments, library=LIBRARY):
    return subprocess.run([sys.executable, "-B", f"{ROOT}/examples/dataset.py", *arguments,
                           "--library", library], capture_output=True, text=True)


def write(out, seed):
    """By continuum: cards that are seen from above stand off their trees."""
    result = run(f"{ROOT}/tests/api/small.json", out, "--count", "2", "--size",
                 f"{WIDTH}x{HEIGHT}", "--samples", "1", "--seed", str(seed),
                 "--method", "continuum")
    need(result.returncode == 0, result.stderr)
    need(sorted(file.name for file in out.iterdir()) ==
         ["00000.exr", "00000.png", "00001.exr", "00001.png", "poses.jsonl"], "files")
    return (out / "poses.jsonl").read_bytes()


def project(line, place_m):
    """Where the pinhole that the line tells of sees a place: x, y and depth."""
    yaw, pitch = line["yaw_rad"], line["pitch_rad"]
    ahead = (math.sin(yaw) * math.cos(pitch), math.cos(yaw) * math.cos(pitch), math.sin(pitch))
    right = (math.cos(yaw), -math.sin(yaw), 0)
    up = (-math.sin(yaw) * math.sin(pitch), -math.cos(yaw) * math.sin(pitch), math.cos(pitch))
    off = [a - b for a, b in zip(place_m, line["position_m"])]
    x, y, depth_m = (sum(a * b for a, b in zip(off, axis)) for axis in (right, up, ahead))
    return line["cx"] + line["fx"] * x / depth_m, line["cy"] - line["fy"] * y / depth_m, depth_m


def check_place(line, tree):
    """The tree's box is where the pinhole sees a block that holds it."""
    east, north, foot_m = tree["position_m"]
    half_m, top_m = 0.4 * tree["height_m"], foot_m + 1.1 * tree["height_m"]
    corners = [project(line, (east + i * half_m, north + j * half_m, z_m))
               for i in (-1, 1) for j in (-1, 1) for z_m in (foot_m - 1, top_m)]
    if min(depth_m for _, _, depth_m in corners) < 0.1:
        return 0
    xs, ys, _ = zip(*corners)
    x0, y0, x1, y1 = tree["box"]
    need(min(xs) - 1 < x0 and x1 < max(xs) + 1 and min(ys) - 1 < y0 and y1 < max(ys) + 1,
         f"{tree} is seen from {min(xs)}, {min(ys)} to {max(xs)}, {max(ys)}")
    return 1


def check_trees(line, picture):
    """The trees of a line are those of the layers that were written."""
    columns = {}
    for pixel, tree_id in enumerate(picture.tree_id[:WIDTH * HEIGHT]):
        columns.setdefault(tree_id, []).append((pixel % WIDTH, pixel // WIDTH))
    columns.pop(0)
    need([tree["id"] for tree in line["trees"]] == sorted(columns), "ids of trees")
    for tree in line["trees"]:
        xs, ys = zip(*columns[tree["id"]])
        need(tree["pixels"] == len(xs), f"pixels of {tree}")
        need(tree["box"] == [min(xs), min(ys), max(xs) + 1, max(ys) + 1], f"box of {tree}")
        need(tree["species"] in ("beech", "spruce") and 9 <= tree["height_m"] <= 20, f"{tree}")
        need(math.isclose(tree["distance_m"], math.dist(tree["position_m"], line["position_m"])),
             f"distance of {tree}")
    placed = sum(check_place(line, tree) for tree in line["trees"])
    print(f"{line['view']}: {placed} of {len(line['trees'])} trees are where the camera sees them")
    need(placed > 20, "too few trees")


def check_picture(line, out, weald):
    png = (out / line["image"]).read_bytes()
    need(png[16:24] == WIDTH.to_bytes(4, "big") + HEIGHT.to_bytes(4, "big"), "size of the PNG")
    need(line["width"] == WIDTH and line["height"] == HEIGHT, "size")
    need((line["cx"], line["cy"]) == (WIDTH / 2, HEIGHT / 2), "principal point")
    need(math.isclose(2 * math.atan(HEIGHT / 2 / line["fy"]), line["fov_rad"]), "focal length")
    need(line["fx"] == line["fy"], "pixels are square")
    picture = dataset.Picture()
    path = str(out / line["layers"]).encode()
    need(weald.wd_picture_read_exr(ctypes.byref(picture), path, None) == 0, "the EXR is read")
    need((picture.width, picture.height) == SIZE and picture.depth_m and picture.species, "layers")
    check_trees(line, picture)
    weald.wd_picture_finish(ctypes.byref(picture))


def check_pictures(scratch):
    out = scratch / "first"
    text = write(out, 3)
    lines = [json.loads(line) for line in text.splitlines()]
    need([line["view"] for line in lines] == ["eye", "drone"], "views")
    need(sum(len(line["trees"]) for line in lines) > 50, "trees")
    weald = dataset.load_library(LIBRARY)
    for line in lines:
        check_picture(line, out, weald)
    need(write(scratch / "again", 3) == text, "the same seed gives another set")
    need(write(scratch / "other", 4) != text, "another seed gives the same set")


def check_failures(scratch):
    """What cannot be done is said and leaves nothing."""
    before = sorted(scratch.iterdir())
    small, out = f"{ROOT}/tests/api/small.json", scratch / "none"
    for result, part in (
            (run(scratch / "nowhere.json", out), "nowhere.json"),
            (run(small, out, library=str(scratch / "nowhere.so")), "nowhere.so"),
            (run(small, out, library=ctypes.util.find_library("c")), "wd_"),
            (run(small, out, "--size", "0x5"), "wd_renderer_render: input error"),
            (run(small, out, "--size", "64"), "--size"),
            (run(small, scratch / "first"), "first is there already"),
            (run(small, scratch / "no" / "folder"), "no")):
        need(result.returncode != 0, f"{part}: it does not fail")
        need(part in result.stderr and "Traceback" not in result.stderr, result.stderr)
        need(sorted(scratch.iterdir()) == before, f"{part}: something is left")


with tempfile.TemporaryDirectory() as folder:
    check_layout(pathlib.Path(folder))
    check_pictures(pathlib.Path(folder))
    check_failures(pathlib.Path(folder))
