/* Prints one figure: figures NAME [GPU]. */
#include "figures.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const struct figure {
    const char *name;
    bool (*run)(const char *gpu);
} figures[] = {
    {"octree-speedup", bench_octree_speedup},
    {"octree-frame-ms", bench_octree_frame},
    {"place-million-s", bench_place_million},
    {"first-frame-warm-s", bench_first_frame_warm},
    {"first-frame-cold-s", bench_first_frame_cold},
    {"peak-memory-mb", bench_peak_memory},
    {"grow-25k-ms", bench_grow},
    {"grow-vs-ez-tree", bench_grow_ratio},
    {"lod-coverage-bias-pct", bench_lod_coverage},
    {"lod-radiance-bias-pct", bench_lod_radiance},
    {"bake-100-cold-s", bench_bake_cold},
    {"bake-100-warm-s", bench_bake_warm},
    {"bake-100-gpu-mb", bench_bake_memory},
    {"oak-20k-mb", bench_oak_memory},
    {"continuum-frame-ms", bench_continuum_frame},
    {"continuum-vs-octree", bench_continuum_vs_octree},
    {"continuum-floor-ratio", bench_continuum_floor},
    {"continuum-moving-ratio", bench_continuum_moving},
    {"continuum-gpu-mb", bench_continuum_memory},
    {"frame-times", bench_frame_times},
    {"continuum-flip", bench_continuum_flip},
    {"continuum-popping", bench_continuum_popping},
    {"scale-1e6-1e9-ratio", bench_scale_ratio},
    {"scale-gpu-mb", bench_scale_memory},
    {"scale-flight-worst", bench_scale_flight},
    {"reference-agreement-pct", bench_reference_agreement},
    {"reference-mrays-s", bench_reference_rays},
    {"mean-colour-error-pct", bench_mean_colour},
    {"brf-error-pct", bench_reflectance},
    {"stand-floor-error-pct", bench_stand_floor},
    {"stand-light-error-pct", bench_stand_light},
    {"shadow-cost-pct", bench_shadow_cost},
    {"wind-cost-pct", bench_wind_cost},
};

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double bench_median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

double bench_now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void bench_remove_directory(const char *path)
{
    DIR *directory = opendir(path);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        char name[512];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        unlink(name);
    }
    if (directory)
        closedir(directory);
    rmdir(path);
}

int main(int argc, char **argv)
{
    size_t count = sizeof figures / sizeof *figures;
    for (size_t i = 0; argc >= 2 && i < count; i++) {
        if (strcmp(figures[i].name, argv[1]) == 0)
            return figures[i].run(argc > 2 ? argv[2] : "software") ? 0 : 1;
    }
    fprintf(stderr, "usage: figures NAME [GPU]; names are\n");
    for (size_t i = 0; i < count; i++)
        fprintf(stderr, "    %s\n", figures[i].name);
    return 2;
}
