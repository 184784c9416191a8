"""A GLB's structure, from its own bytes: chunks, bounds, ranges, unit normals, levels.
   glb_check.py FILE [NAME=VALUE...]: also compares counts of what is in it; with trees=LIST.csv
   where its instances stand with the list's rows."""

import csv
import json
import struct
import sys

SIZES = {5121: 1, 5123: 2, 5125: 4, 5126: 4}
PARTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}


def need(condition, what):
    if not condition:
        sys.exit(f"{sys.argv[1]}: {what}")


def chunks(data):
    magic, version, length = struct.unpack_from("<4sII", data)
    need(magic == b"glTF" and version == 2 and length == len(data), "header")
    size, kind = struct.unpack_from("<I4s", data, 12)
    need(kind == b"JSON" and size % 4 == 0, "JSON chunk")
    root = json.loads(data[20 : 20 + size])
    at = 20 + size
    size, kind = struct.unpack_from("<I4s", data, at)
    need(kind == b"BIN\0" and size % 4 == 0 and at + 8 + size == len(data), "BIN chunk")
    return root, data[at + 8 :]


def values(root, binary, index):
    accessor = root["accessors"][index]
    view = root["bufferViews"][accessor["bufferView"]]
    kind, parts = accessor["componentType"], PARTS[accessor["type"]]
    count = accessor["count"] * parts
    need(count > 0, f"accessor {index} is empty")
    need(view.get("byteOffset", 0) % 4 == 0, f"view of accessor {index} is not aligned")
    need(count * SIZES[kind] <= view["byteLength"], f"accessor {index} leaves its view")
    flat = struct.unpack_from(f"<{count}{FORMATS[kind]}", binary, view.get("byteOffset", 0))
    for bound, pick in (("min", min), ("max", max)):
        for part, value in enumerate(accessor.get(bound, [])):
            need(abs(pick(flat[part::parts]) - value) < 1e-5, f"accessor {index}: {bound}")
    return flat, parts


def check_primitive(root, binary, primitive):
    attributes = primitive["attributes"]
    count = {root["accessors"][index]["count"] for index in attributes.values()}
    need(len(count) == 1, "attributes differ in length")
    need("min" in root["accessors"][attributes["POSITION"]], "positions without bounds")
    indices, _ = values(root, binary, primitive["indices"])
    need(len(indices) % 3 == 0 and max(indices) < count.pop(), "indices out of range")
    normals, _ = values(root, binary, attributes["NORMAL"])
    for i in range(0, len(normals), 3):
        length = sum(n * n for n in normals[i : i + 3])
        need(abs(length - 1) < 2e-3, f"normal {i // 3} has length {length}")
    need(0 <= primitive["material"] < len(root["materials"]), "material")


def tree_places(root, binary):
    """Places by id: x, y, z with z up, as the extras' origin has them."""
    origin = root["scenes"][0]["extras"]["origin_m"]
    places = {}
    for node in root["nodes"]:
        extensions = node.get("extensions", {})
        if "MSFT_lod" not in extensions or "EXT_mesh_gpu_instancing" not in extensions:
            continue
        attributes = extensions["EXT_mesh_gpu_instancing"]["attributes"]
        ids, _ = values(root, binary, attributes["_TREE_ID"])
        at, _ = values(root, binary, attributes["TRANSLATION"])
        scale = node.get("scale", [1, 1, 1])
        for i, number in enumerate(ids):
            x, y, z = (at[3 * i + k] * scale[k] for k in range(3))
            places[int(number)] = (origin[0] + x, origin[1] - z, origin[2] + y)
    return places


def check_trees(root, binary, path):
    places = tree_places(root, binary)
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    need(len(rows) == len(places), f"{len(places)} trees instead of {len(rows)}")
    for row in rows:
        for found, name in zip(places[int(row["id"])], ("x_m", "y_m", "z_m")):
            need(abs(found - float(row[name])) < 2e-3, f"tree {row['id']}: {name} {found}")


def main():
    with open(sys.argv[1], "rb") as file:
        root, binary = chunks(file.read())
    need(root["buffers"][0]["byteLength"] <= len(binary), "buffer")
    for view in root["bufferViews"]:
        need(view["byteOffset"] + view["byteLength"] <= len(binary), "view leaves the buffer")
    for index in range(len(root["accessors"])):
        values(root, binary, index)
    for mesh in root["meshes"]:
        need(mesh["primitives"], "mesh without primitives")
        for primitive in mesh["primitives"]:
            check_primitive(root, binary, primitive)
    for image in root.get("images", []):
        view = root["bufferViews"][image["bufferView"]]
        need(binary[view["byteOffset"] :][:4] == b"\x89PNG", "image is no PNG")
    levels = instances = mirrored = 0
    for node in root["nodes"]:
        extensions = node.get("extensions", {})
        need(set(extensions) <= set(root.get("extensionsUsed", [])), "extension not declared")
        for index in extensions.get("MSFT_lod", {}).get("ids", []):
            need("mesh" in root["nodes"][index], "level without a mesh")
            levels += 1
        places = extensions.get("EXT_mesh_gpu_instancing", {}).get("attributes", {})
        if places:
            need(min(values(root, binary, places["SCALE"])[0]) > 0, "instance that turns triangles inside out")
            mirrored += "MSFT_lod" in extensions and node.get("scale", [1])[0] < 0
        if "MSFT_lod" in extensions and places:
            instances += root["accessors"][places["TRANSLATION"]]["count"]
    found = {"levels": levels, "instances": instances, "mirrored": mirrored,
             "roots": len(root["scenes"][0]["nodes"])}
    for word in sys.argv[2:]:
        name, value = word.split("=", 1)
        if name == "trees":
            check_trees(root, binary, value)
            continue
        need(found[name] == int(value), f"{name} {found[name]} instead of {value}")
    print(f"{sys.argv[1]}: {found}")


main()
