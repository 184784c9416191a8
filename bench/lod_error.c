/* Errors of reduced forms: lod-error [--quick] [--clouds] [--form NAME]... [--px HEIGHT]... [SPECIES]...
 * Without a form, a height or a species: all of them. Quick: with 16 samples a pixel to compare with, not 64. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lod.h"

enum { MAX_SPECIES = 64 };

static bool add_form(unsigned *forms, const char *name)
{
    for (int i = 1; i < BIAS_FORMS; i++) {
        if (strcmp(bias_forms[i].name, name) == 0) {
            *forms |= 1u << i;
            return true;
        }
    }
    fprintf(stderr, "lod-error: there is no form \"%s\"\n", name);
    return false;
}

static bool add_height(unsigned *heights, const char *text)
{
    for (int i = 0; i < BIAS_HEIGHTS; i++) {
        if (bias_height_px[i] == atoi(text)) {
            *heights |= 1u << i;
            return true;
        }
    }
    fprintf(stderr, "lod-error: no height of %s px is measured\n", text);
    return false;
}

static void print_worst(const char *among, const char *what, const struct lod_case *worst)
{
    if (worst->name[0])
        printf("worst %s, %s: %+.1f%%  %s\n", what, among, worst->pct, worst->name);
}

int main(int argc, char **argv)
{
    const char *species[MAX_SPECIES + 1] = {0};
    struct lod_choice choice = {.gpu = "software", .species = species};
    struct lod_worst worst;
    int count = 0;
    bool ok = true;
    for (int i = 1; i < argc && ok; i++) {
        if (strcmp(argv[i], "--form") == 0 && i + 1 < argc)
            ok = add_form(&choice.forms, argv[++i]);
        else if (strcmp(argv[i], "--px") == 0 && i + 1 < argc)
            ok = add_height(&choice.heights, argv[++i]);
        else if (strcmp(argv[i], "--quick") == 0)
            choice.quick = true;
        else if (strcmp(argv[i], "--clouds") == 0)
            choice.clouds = true;
        else if (argv[i][0] != '-' && count < MAX_SPECIES)
            species[count++] = argv[i];
        else
            ok = false;
    }
    choice.forms = choice.forms ? choice.forms : ~0u;
    choice.heights = choice.heights ? choice.heights : ~0u;
    if (!ok) {
        fprintf(stderr, "usage: lod-error [--quick] [--clouds] [--form NAME]... [--px HEIGHT]... [SPECIES]...\n");
        return 2;
    }
    if (!lod_run(&worst, &choice))
        return 1;
    print_worst("used", "coverage", &worst.used_coverage);
    print_worst("used", "radiance", &worst.used_radiance);
    print_worst("all", "coverage", &worst.coverage);
    print_worst("all", "radiance", &worst.radiance);
    return 0;
}
