#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "args.h"
#include "help.h"

static const struct cli_command commands[] = {
    {"render", CLI_RENDER, "SCENE -o FILE", 1, 1, "draw a picture or a film",
     "Draws a picture of a scene, or a film of it along a path or of its wind. An .exr holds all\n"
     "layers: colour, depth in metres, world normal, albedo, species, 32-bit tree id, velocity.\n"
     "Ctrl-C stops a film after the frames that are finished; these are kept in FILE and, as after a\n"
     "kill, in FILE.partial (about 15 MB for a frame of 3840x2160), from which the same command goes\n"
     "on to the same film. With --reference a picture is path-traced on the processor; stopped, it\n"
     "leaves FILE.partial, too.",
     "  weald render scenes/valley.json -o valley.png\n"
     "  weald render scenes/valley.json -o valley.exr --camera overview --size 1920x1080\n"
     "  weald render scenes/valley.json -o flight.mp4 --path flight --samples 4\n"
     "  weald render scenes/valley.json -o frame-%05d.png --path flight --frames 48\n"
     "  weald render scenes/valley.json -o truth.exr --reference --samples 256\n"
     "  weald render scenes/valley.json -o lod.png --view lod --method octree --times\n"
     "  weald render scenes/osg.json -o calm.png --set wind.speed_mps=0\n",
     cli_render},
    {"grow", CLI_GROW, "SPECIES|FILE... -o FILE", 0, 64,
     "grow a tree, or read a model: as a picture, a GLB or an OBJ",
     "Grows one individual of a species, or reads an artist's model (.obj, .gltf, .glb, .fbx, .dae)\n"
     "as a tree, and draws it on plain ground or writes it for other programs. A model takes --height\n"
     "alone of what says how a species grows. Several stand side by side. A .glb holds every level of\n"
     "detail (MSFT_lod) and all textures; metres, y up.",
     "  weald grow oak --age 80 --open 1 --seed 3 -o oak.glb\n"
     "  weald grow spruce --height 25 --open 1 -o spruce.png\n"
     "  weald grow birch --variants 5 --season autumn -o birches.png --size 1600x700\n"
     "  weald grow maple.obj --height 18 -o maple.png --camera-distance 6\n"
     "  weald grow --sheet oak beech pine -o sheet.png\n",
     cli_grow},
    {"export", CLI_EXPORT, "SCENE -o FILE", 1, 1, "write a scene for other programs",
     "Plants a scene and writes its trees and its ground as one .glb: each individual's meshes once,\n"
     "with levels of detail (MSFT_lod), and where it stands (EXT_mesh_gpu_instancing). Metres, y up,\n"
     "about the middle of the ground, whose own coordinates are in the scene's extras. Or writes its\n"
     "trees as a .csv, a row for each: id (as in the tree_id layer of pictures), species, place in the\n"
     "terrain's own coordinates, height, crown diameter, layer, and as tag what an inventory's\n"
     "column for \"id\" calls it. Ctrl-C leaves no file.",
     "  weald export scenes/bei.json --data ~/data -o bei.glb\n"
     "  weald export scenes/valley.json -o valley.glb --max-trees 2000000\n"
     "  weald export scenes/valley.json -o trees.csv\n",
     cli_export},
    {"view", CLI_VIEW, "SCENE", 1, 1, "walk or fly through a scene in a window",
     "Opens a window to walk and fly through a scene. Cameras saved with Shift+C go to\n"
     "SCENE.cameras.json beside the scene, or to the working directory; --camera names these, too, also of weald render.",
     "  weald view scenes/valley.json\n"
     "  weald view scenes/valley.json --walk --size 1920x1080\n"
     "  weald view scenes/valley.json --gpu software --size 480x270\n",
     cli_view},
    {"info", CLI_INFO, "SCENE", 1, 1, "tell what stands in a scene",
     "Plants a scene and tells its trees by species, bounds, memory, inventories, cameras and\n"
     "paths, and the devices that could draw it.",
     "  weald info scenes/valley.json\n"
     "  weald info scenes/valley.json --json | jq .tree_count\n",
     cli_info},
    {"check", CLI_CHECK, "FILE...", 1, 1 << 20,
     "look for faults in scene, species, CSV and raster files",
     "Checks files: scenes and species (.json), inventories (.csv), rasters (anything else). A scene's ground\n"
     "is made, its inventories are planted and the maps of its layers read as it would; layers are not planted\n"
     "(they may have too many trees, or none), models of its species not read, and its sky need only be there\n"
     "and readable. Faults are named with file and line or key. Exits with 1 if any file has one.",
     "  weald check scenes/*.json species/*.json\n"
     "  weald check my-plot.csv --data ~/plots\n",
     cli_check},
    {"batch", CLI_BATCH, "FILE", 1, 1, "run many commands with one start",
     "Runs a file's lines, each a command as after `weald` (render, grow, export, info, check; - reads\n"
     "standard input). Device and shaders are opened once, which saves most of what small pictures take;\n"
     "lines that follow each other and differ in method, camera, time, size or samples alone share a forest,\n"
     "of files as they were at the first of them.\n"
     "Quotes keep blanks in a word, # begins a comment; nothing else of a shell's is known. All lines are\n"
     "read before the first is run: one that cannot be ends it with 2. One that fails is named, the others\n"
     "are run, and the exit status is 1. Another --gpu, --gpu-validate or --threads opens the device anew.\n"
     "Ctrl-C ends it after the running step and tells the next line; --skip-existing goes on from there.",
     "  weald batch pictures.txt\n"
     "  weald batch pictures.txt --skip-existing\n"
     "  for s in 1 2 3; do echo render scenes/valley.json --seed $s -o $s.png; done | weald batch -\n",
     cli_batch},
    {"schema", CLI_SCHEMA, "scene|species|model", 1, 1, "print the JSON Schema of a kind of file",
     "Prints the JSON Schema of scene or species files.",
     "  weald schema scene > scene.schema.json\n", cli_schema},
    {"devices", CLI_DEVICES, "", 0, 0, "list the Vulkan devices",
     "Lists the Vulkan devices that --gpu can name.", "  weald devices\n", cli_devices},
    {"bench", CLI_BENCH, "[SCENE...] --suite NAME -o DIR", 0, 64,
     "measure methods against each other and the truth",
     "Draws scenes with every method and measures time, memory, and how far the pictures are from\n"
     "path-traced ones; prints a table and leaves results.csv, results.json and report.html in DIR.\n"
     "Stopped, the same command goes on. Suites:\n"
     "  seeds    the scenes of the seed documents      quality  every camera of two forests\n"
     "  scale    up to a billion trees                 popping  slow camera paths\n"
     "  density  more and more trees on a square kilometre",
     "  weald bench --suite seeds --quick -o out/bench\n"
     "  weald bench --suite quality --methods octree,lod --metric ssim -o out/bench\n"
     "  weald bench my-scene.json --suite quality -o out/bench\n",
     cli_bench},
    {"methods", CLI_METHODS, "[NAME]", 0, 1, "list the methods that draw trees and their options",
     "Lists every method with its options: what they take, their defaults, the row of\n"
     "docs/methods.md that each stands for. With NAME that method alone.",
     "  weald methods\n"
     "  weald methods octree\n"
     "  weald render scenes/valley.json -o a.png --method octree --option max_cull_depth=5\n",
     cli_methods},
    {"manual", CLI_MANUAL, "", 0, 0, "print the manual page", "Prints the manual page, for man(1).",
     "  weald manual | man -l -\n", cli_manual},
    {0},
};

const struct cli_command *cli_commands(void)
{
    return commands;
}

const struct cli_command *cli_command_find(const char *name)
{
    for (const struct cli_command *command = commands; command->name; command++)
        if (!strcmp(command->name, name))
            return command;
    return NULL;
}

static enum cli_status complain_command(const char *name)
{
    const char *names[sizeof commands / sizeof *commands] = {0};
    for (size_t i = 0; commands[i].name; i++)
        names[i] = commands[i].name;
    const char *suggestion = cli_suggest(name, names);
    fprintf(stderr, "weald: there is no command %s%s%s%s\n", name,
            suggestion ? ", did you mean " : "", suggestion ? suggestion : "",
            suggestion ? "?" : "");
    fprintf(stderr, "Try 'weald --help'.\n");
    return CLI_USAGE;
}

static enum cli_status run_command(const struct cli_command *command, int word_count, char **words)
{
    struct cli_options options = {0};
    char **operands = calloc((size_t)word_count + 1, sizeof *operands);
    enum cli_status status = CLI_USAGE;
    if (!operands)
        return CLI_FAILED;
    if (cli_options_parse(command, word_count, words, operands, &options)) {
        struct cli_session session;
        if (options.help) {
            cli_help_command(stdout, command);
            status = CLI_OK;
        } else if (!cli_session_start(&session, &options)) {
            status = CLI_FAILED;
        } else {
            status = command->run(&session);
            cli_session_finish(&session);
        }
    }
    free(operands);
    return status;
}

static enum cli_status run(int word_count, char **words)
{
    if (word_count < 1) {
        cli_help_program(stderr);
        return CLI_USAGE;
    }
    if (!strcmp(words[0], "--version")) {
        printf("weald %s\n", wd_version());
        return CLI_OK;
    }
    if (!strcmp(words[0], "--help") || !strcmp(words[0], "-h") || !strcmp(words[0], "help")) {
        cli_help_program(stdout);
        return CLI_OK;
    }
    const struct cli_command *command = cli_command_find(words[0]);
    return command ? run_command(command, word_count - 1, words + 1) : complain_command(words[0]);
}

int main(int argc, char **argv)
{
    enum cli_status status = run(argc - 1, argv + 1);
    if (fflush(stdout) || ferror(stdout)) {
        perror("weald: standard output");
        return CLI_FAILED;
    }
    return status;
}
