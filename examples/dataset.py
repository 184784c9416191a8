#!/usr/bin/env python3
"""Writes a small training set: pictures of a forest, their labels and their cameras.

    dataset.py scenes/valley.json OUT --count 20 --size 640x480 --samples 4

Picture i is OUT/iiiii.png (RGB), OUT/iiiii.exr (Z: depth in metres; species; tree_id; all by
docs/methods.md, "Pictures as data") and a line of OUT/poses.jsonl. Places are in the scene's
local frame: metres east, north and up of the terrain's south-west corner; with origin_m added,
in the terrain's own coordinates. The camera is a pinhole without distortion:
  yaw_rad, pitch_rad, roll_rad  turn it clockwise from north, up from the horizon, and never
  fx, fy, cx, cy  are in pixels from the picture's upper left corner
  trees  are those in sight: id, pixels (how many), box (x0, y0, x1, y1 in pixels, x1 and y1 just
         beyond), species (as the scene names it: "open beech") and its Latin name, position_m of
         the foot, height_m, distance_m of the foot
Even pictures are seen by a person's eyes, odd ones from a drone, over water where it stands. The
same seed gives the same set on the same device and driver. Needs libweald and nothing but Python's
own library.
"""
import argparse
import contextlib
import ctypes
import json
import math
import os
import pathlib
import random
import sys
import tempfile
from ctypes import (POINTER, Structure, byref, c_bool, c_char_p, c_double, c_float, c_int,
                    c_uint32, c_uint64, c_void_p)

LAYER_DISPLAY, LAYER_DEPTH, LAYER_SPECIES, LAYER_TREE_ID = 1 << 0, 1 << 2, 1 << 5, 1 << 6
# Metres over the ground and pitch in degrees, each from and to, of even and of odd pictures.
VIEWS = {"eye": ((1.7, 1.7), (-5, 10)), "drone": ((25, 60), (-60, -20))}
CLEAR_M = 1.5  # nine tenths of a picture are farther off than this: no crown or stem is before it
TRIES = 100    # to find such a view


# Structures of include/weald/*.h, whole; pointers that are not followed here are c_void_p.
VERSION = "0.1"

class Log(Structure):
    _fields_ = [("sink", c_void_p), ("user", c_void_p)]  # NULL: errors go to standard error


class Progress(Structure):
    _fields_ = [("report", c_void_p), ("user", c_void_p)]


class ForestParams(Structure):
    _fields_ = [("scene_path", c_char_p), ("data_dir", c_char_p), ("settings", c_void_p),
                ("seed", c_char_p), ("threads", c_uint32), ("max_trees", c_uint64),
                ("progress", Progress), ("log", Log)]


class ForestInfo(Structure):
    _fields_ = [("name", c_char_p), ("tree_count", c_uint64), ("last_id", c_uint32),
                ("on_demand", c_bool), ("species_count", c_uint32), ("layer_count", c_uint32),
                ("inventory_count", c_uint32), ("min_m", c_double * 3), ("max_m", c_double * 3),
                ("origin_m", c_double * 2), ("crs", c_char_p), ("host_bytes", c_uint64),
                ("hash", c_uint64), ("seed", c_uint32), ("octant_count", c_uint32),
                ("octree_depth", c_uint32), ("terrain_cell_m", c_double), ("terrain_ha", c_double)]


class SpeciesInfo(Structure):
    _fields_ = [("name", c_char_p), ("latin", c_char_p), ("tree_count", c_uint64)]


class TreeInfo(Structure):
    _fields_ = [("id", c_uint32), ("species", c_uint32), ("position_m", c_double * 3),
                ("height_m", c_double), ("crown_diameter_m", c_double), ("yaw_rad", c_double)]


class Camera(Structure):
    _fields_ = [("position_m", c_double * 3), ("yaw_rad", c_double), ("pitch_rad", c_double),
                ("fov_rad", c_double)]


class RendererParams(Structure):
    _fields_ = [("gpu", c_char_p), ("validation", c_int), ("cache_dir", c_char_p),
                ("threads", c_uint32), ("progress", Progress), ("log", Log)]


class RenderParams(Structure):
    _fields_ = [("camera", Camera), ("previous_camera", c_void_p), ("sun", c_void_p),
                ("time_s", c_double), ("previous_time_s", c_double), ("width", c_uint32),
                ("height", c_uint32), ("samples", c_uint32), ("method", c_char_p), ("view", c_int),
                ("layers", c_uint32), ("max_error_px", c_double), ("accumulation", c_int),
                ("timing", c_int)]


class Picture(Structure):
    _fields_ = [("width", c_uint32), ("height", c_uint32), ("display", c_void_p),
                ("color", c_void_p), ("depth_m", POINTER(c_float)), ("normal", c_void_p),
                ("albedo", c_void_p), ("species", c_void_p), ("tree_id", POINTER(c_uint32)),
                ("velocity_px", c_void_p), ("rank_tree", c_void_p), ("rank_share", c_void_p),
                ("camera", Camera), ("sun", c_double * 2), ("time_s", c_double),
                ("about", c_char_p)]


class WealdError(Exception):
    """A call failed (the library has said why on standard error), or it is of another version."""


def load_library(path):
    """The library. Calls that fail raise WealdError; arguments are to be objects of ctypes."""
    weald = ctypes.CDLL(path)

    def check(result, function, _arguments):
        if result != 0:
            raise WealdError(f"{function.__name__}: {weald.wd_result_name(result).decode()} error")

    weald.wd_version.restype = weald.wd_result_name.restype = c_char_p
    version = weald.wd_version().decode()
    if version.rpartition(".")[0] != VERSION:
        raise WealdError(f"{path} is weald {version}, these structures are of {VERSION}")
    for function in (weald.wd_forest_create, weald.wd_renderer_create,
                     weald.wd_renderer_set_forest, weald.wd_renderer_render,
                     weald.wd_picture_write):
        function.errcheck = check
    weald.wd_forest_get_tree.restype = weald.wd_forest_get_species.restype = c_bool
    weald.wd_forest_ground_m.restype = weald.wd_forest_water_m.restype = c_double
    return weald


class Scene:
    """A forest and a renderer that draws it; `stack` frees them at its end."""

    def __init__(self, weald, stack, path, data):
        self.weald, self.forest, self.renderer = weald, c_void_p(), c_void_p()
        self.info = ForestInfo()
        files = ForestParams(scene_path=path, data_dir=data)
        weald.wd_forest_create(byref(self.forest), byref(files))
        stack.callback(weald.wd_forest_destroy, byref(self.forest))
        weald.wd_forest_get_info(self.forest, byref(self.info))
        weald.wd_renderer_create(byref(self.renderer), byref(RendererParams()))
        stack.callback(weald.wd_renderer_destroy, byref(self.renderer))
        weald.wd_renderer_set_forest(self.renderer, self.forest)

    def random_camera(self, rng, view, fov_deg):
        """A camera over any place in the scene, turned toward another."""
        spans = list(zip(self.info.min_m[:2], self.info.max_m[:2]))
        x, y = (low + (high - low) * rng.uniform(0.1, 0.9) for low, high in spans)
        to_x, to_y = (rng.uniform(low, high) for low, high in spans)
        heights_m, pitches_deg = VIEWS[view]
        place = self.forest, c_double(x), c_double(y)
        floor_m = max(self.weald.wd_forest_ground_m(*place), self.weald.wd_forest_water_m(*place))
        return Camera((x, y, floor_m + rng.uniform(*heights_m)), math.atan2(to_x - x, to_y - y),
                      math.radians(rng.uniform(*pitches_deg)), math.radians(fov_deg))

    def trees(self, picture):
        """The trees that a picture shows, by id."""
        boxes = {}
        for pixel, tree_id in enumerate(picture.tree_id[:picture.width * picture.height]):
            if tree_id != 0:
                y, x = divmod(pixel, picture.width)
                pixels, x0, y0, x1, _ = boxes.get(tree_id, (0, x, y, x, y))
                boxes[tree_id] = pixels + 1, min(x0, x), y0, max(x1, x + 1), y + 1
        tree, species = TreeInfo(), SpeciesInfo()
        for tree_id, (pixels, *box) in sorted(boxes.items()):
            if not self.weald.wd_forest_get_tree(self.forest, c_uint32(tree_id), byref(tree)):
                raise WealdError(f"the forest has no tree {tree_id}")
            self.weald.wd_forest_get_species(self.forest, c_uint32(tree.species), byref(species))
            yield {"id": tree_id, "pixels": pixels, "box": box, "species": species.name.decode(),
                   "latin": (species.latin or b"").decode(), "position_m": tree.position_m[:], "height_m": tree.height_m,
                   "distance_m": math.dist(picture.camera.position_m, tree.position_m)}

    def describe(self, picture):
        """What poses.jsonl tells of a picture."""
        camera = picture.camera
        focal_px = picture.height / (2 * math.tan(camera.fov_rad / 2))
        return {"width": picture.width, "height": picture.height,
                "position_m": camera.position_m[:], "origin_m": self.info.origin_m[:],
                "yaw_rad": camera.yaw_rad, "pitch_rad": camera.pitch_rad, "roll_rad": 0.0,
                "fov_rad": camera.fov_rad, "fx": focal_px, "fy": focal_px,
                "cx": picture.width / 2, "cy": picture.height / 2,
                "trees": list(self.trees(picture))}

    def write_picture(self, params, folder, names):
        """Draws and writes a picture and returns its description, or None if something is
        right before the camera."""
        picture = Picture()
        self.weald.wd_renderer_render(self.renderer, byref(params), byref(picture))
        try:
            depths_m = sorted(picture.depth_m[:picture.width * picture.height])
            if depths_m[len(depths_m) // 10] < CLEAR_M:
                return None
            for name in names.values():
                path = os.fsencode(folder / name)
                self.weald.wd_picture_write(byref(picture), path, None)
            return self.describe(picture)
        finally:
            self.weald.wd_picture_finish(byref(picture))


def write_set(args, scene, folder):
    """Writes all pictures and poses.jsonl into a folder."""
    rng = random.Random(args.seed)
    params = RenderParams(
        width=args.size[0], height=args.size[1], samples=args.samples, method=args.method,
        layers=LAYER_DISPLAY | LAYER_DEPTH | LAYER_SPECIES | LAYER_TREE_ID)
    with open(folder / "poses.jsonl", "w", encoding="utf-8") as poses:
        for i in range(args.count):
            view = "drone" if i % 2 else "eye"
            names = {"image": f"{i:05d}.png", "layers": f"{i:05d}.exr"}
            for _ in range(TRIES):
                params.camera = scene.random_camera(rng, view, args.fov)
                if line := scene.write_picture(params, folder, names):
                    break
            else:
                raise WealdError(f"picture {i}: none of {TRIES} places has a clear view")
            poses.write(json.dumps({**names, "view": view, **line}) + "\n")


def size(text):
    width, height = text.split("x")
    return int(width), int(height)


def parse_arguments():
    summary, example, *_ = __doc__.split("\n\n")
    parser = argparse.ArgumentParser(description=summary, epilog=f"example: {example.strip()}")
    parser.add_argument("scene", type=os.fsencode, help="a scene file")
    parser.add_argument("out", type=pathlib.Path, help="folder to make")
    parser.add_argument("--count", type=int, default=10, help="pictures (10)")
    parser.add_argument("--size", type=size, default=(640, 480), metavar="WxH",
                        help="in pixels (640x480)")
    parser.add_argument("--fov", type=float, default=60, metavar="DEG",
                        help="vertical field of view (60)")
    parser.add_argument("--samples", type=int, default=4, help="for a pixel (4)")
    parser.add_argument("--seed", type=int, default=1, help="of the cameras (1)")
    parser.add_argument("--method", type=os.fsencode, help="to draw trees by (the scene's)")
    parser.add_argument("--data", type=os.fsencode, metavar="DIR", help="the scene's ${data}")
    parser.add_argument("--library", default="libweald.so.0", metavar="PATH",
                        help="libweald, if it is not where programs find libraries")
    args = parser.parse_args()
    if args.count < 1:
        parser.error("--count is at least 1")
    return args


def main():
    args = parse_arguments()
    try:
        if args.out.exists():
            raise FileExistsError(f"{args.out} is there already")
        with contextlib.ExitStack() as stack:
            weald = load_library(args.library)
            scratch = stack.enter_context(tempfile.TemporaryDirectory(
                prefix=f"{args.out.name}.partial-", dir=args.out.parent))
            folder = pathlib.Path(scratch, "set")  # becomes `out` when it is whole
            folder.mkdir()
            write_set(args, Scene(weald, stack, args.scene, args.data), folder)
            folder.rename(args.out)
    except (OSError, AttributeError, WealdError) as error:  # AttributeError: another library
        sys.exit(f"dataset.py: {error}")


if __name__ == "__main__":
    main()
