#!/bin/sh
# Include rules: a folder may include only what stands left of it in the way of the data, where frame
# and methods stand at one place.
#   includes.sh ROOT
set -eu
cd "$1"

# folder: what it may include besides its own files, system headers and the public headers
rules='
src/base:
src/scene: base
src/world: base scene
src/tree: base scene
src/gpu: base
src/bake: base scene tree gpu
src/forest: base scene world tree gpu bake
src/frame: base scene world tree gpu bake forest methods
src/methods: base scene world tree gpu bake forest frame
src/reference: base scene world tree
src/output: base
src/api: base scene world tree gpu bake forest frame methods reference output
cli: viewer
viewer:
examples:
bench: base scene world tree
'

# Quoted includes with a folder, as "file:line folder"; weald/ and shared/ are open to all.
find src cli viewer examples bench -name '*.c' -o -name '*.h' -o -name '*.cpp' | sort |
    xargs awk -v rules="$rules" '
    BEGIN {
        count = split(rules, lines, "\n")
        for (i = 1; i <= count; i++) {
            if (!split(lines[i], part, ":"))
                continue
            allowed[part[1]] = " " part[2] " "
        }
    }
    /^[ \t]*#[ \t]*include[ \t]*"[^"]*\// {
        split($0, quoted, "\"")
        target = quoted[2]
        sub(/\/.*/, "", target)
        split(FILENAME, path, "/")
        folder = path[1] == "src" ? "src/" path[2] : path[1]
        own = path[1] == "src" ? path[2] : path[1]
        if (target == own || target == "weald" || (target == "shared" && path[1] == "src"))
            next
        if (!(folder in allowed)) {
            print FILENAME ": folder " folder " has no include rule; add one"
            bad++
        } else if (!index(allowed[folder], " " target " ")) {
            print FILENAME ":" FNR ": " folder " may not include " quoted[2]
            bad++
        }
    }
    END { exit bad > 0 }'

# The window system and the panels belong to the viewer, public headers know only Vulkan.
found=$(grep -rnE '#include *[<"](SDL|imgui)' src cli examples bench include || true)
found=$found$(grep -rn '#include *<vulkan' include | grep -v '^include/weald/vulkan.h' || true)
[ -z "$found" ] || {
    echo "$found"
    echo "SDL and imgui may be included by viewer/ only, Vulkan by weald/vulkan.h only"
    exit 1
}
