"""Every scene and species file validates against the published schemas. 77: not installed."""
import glob
import json
import re
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed: skipped")
    sys.exit(77)


def blank(text):
    """Comments become nothing; strings stay."""
    pattern = r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/'
    return re.sub(pattern, lambda m: m[0] if m[0][0] == '"' else " ", text, flags=re.S)


def validate(root, kind, folder):
    with open(f"{root}/docs/{kind}.schema.json", encoding="utf-8") as file:
        schema = json.load(file)
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    wrong = 0
    paths = sorted(glob.glob(f"{root}/{folder}/*.json"))
    for path in paths:
        with open(path, encoding="utf-8") as file:
            for error in validator.iter_errors(json.loads(blank(file.read()))):
                print(f"{path}: {error.json_path}: {error.message}")
                wrong += 1
    print(f"{len(paths)} {kind} files, {wrong} errors")
    return wrong or not paths


def refuses(root):
    """The schema is no rubber stamp: it refuses what the reader refuses."""
    with open(f"{root}/docs/scene.schema.json", encoding="utf-8") as file:
        validator = jsonschema.Draft202012Validator(json.load(file))
    bad = [{"seeds": 1}, {"seed": -1}, {"terrain": {"kind": "round"}}, {"layers": [{}]},
           {"quality": {"width": 0}}, {"cameras": [{"name": "a", "position_m": [0, 0]}]}]
    return sum(1 for scene in bad if validator.is_valid(scene))


if __name__ == "__main__":
    ROOT = sys.argv[1]
    RESULTS = [validate(ROOT, "scene", "scenes"), validate(ROOT, "species", "species"),
               refuses(ROOT)]
    sys.exit(1 if any(RESULTS) else 0)
