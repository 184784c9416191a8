/* preview: draws a bare landscape to PPM pictures, for looking at ground, light and sky.
 *   preview DIRECTORY [name...] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "picture.h"

struct shot {
    const char *name;
    double x, y, above_m, yaw_deg, pitch_deg;
    double sun_azimuth_deg, sun_elevation_deg;
    double water_above_m; /* over the lowest ground; 0: none */
};

static const struct shot shots[] = {
    {"noon", 0.5, 0.30, 30, 0, -8, 200, 55, 0},
    {"valley", 0.42, 0.2, 120, 15, -8, 230, 35, 40},
    {"low", 0.5, 0.5, 60, 290, -4, 285, 7, 40},
    {"away", 0.5, 0.5, 60, 110, -6, 285, 7, 40},
    {"above", 0.5, 0.1, 2500, 0, -35, 140, 40, 40},
    {"eye", 0.55, 0.4, 1.7, 20, -12, 200, 45, 0},
    {"dusk", 0.5, 0.5, 60, 290, 4, 285, -4, 40},
    {"night", 0.5, 0.5, 60, 290, 4, 285, -30, 40},
    {"sky", 0.5, 0.5, 60, 200, 35, 200, 40, 0},
    {"lake", 0.5, 0.45, 8, 290, -6, 285, 15, 60},
};

static void write_ppm(const char *directory, const char *name, const uint8_t *rgba, uint32_t width,
                      uint32_t height)
{
    char *path = wd_format("%s/%s.ppm", directory, name);
    FILE *file = fopen(path, "wb");
    if (!file) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(1);
    }
    fprintf(file, "P6 %u %u 255\n", width, height);
    for (size_t i = 0; i < (size_t)width * height; i++)
        fwrite(rgba + 4 * i, 1, 3, file);
    fclose(file);
    free(path);
}

static void draw_shot(struct picture_test *test, const struct shot *shot, const char *directory)
{
    double extent = wd_terrain_extent_x_m(&test->world.terrain);
    struct wd_camera camera = picture_camera(test, shot->x * extent, shot->y * extent,
                                             shot->above_m, shot->yaw_deg, shot->pitch_deg);
    test->scene.sun.azimuth_deg = shot->sun_azimuth_deg;
    test->scene.sun.elevation_deg = shot->sun_elevation_deg;
    test->scene.water.enabled = shot->water_above_m > 0;
    test->scene.water.level_m = test->world.terrain.min_m + shot->water_above_m;
    if (camera.position_m[2] < test->scene.water.level_m + 2 && test->scene.water.enabled)
        camera.position_m[2] = test->scene.water.level_m + 2;
    double start_s = wd_clock_s();
    if (!picture_draw(test, &camera))
        exit(1);
    printf("%s: first %.0f ms", shot->name, 1e3 * (wd_clock_s() - start_s));
    test->frames.timing = WD_TIMING_ON;
    if (!picture_draw(test, &camera))
        exit(1);
    test->frames.timing = WD_TIMING_OFF;
    printf(", %llu triangles", (unsigned long long)test->terrain.triangles);
    for (uint32_t i = 0; i < test->frames.last_scope_count; i++)
        printf(", %s %.1f ms", test->frames.last_scopes[i].name,
               test->frames.last_scopes[i].gpu_us * 1e-3);
    printf("\n");
    fflush(stdout);
    uint8_t *display = picture_display(test);
    write_ppm(directory, shot->name, display, test->targets.width, test->targets.height);
    free(display);
}

static bool is_wanted(const char *name, int count, char **names)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(names[i], name) == 0)
            return true;
    }
    return count == 0;
}

int main(int argc, char **argv)
{
    static struct picture_test test;
    if (argc < 2 || !picture_init(&test, 800, 600, 1024, 8, 900))
        return 1;
    test.scene.ground.tree_line_m = test.world.terrain.min_m + 600;
    test.scene.ground.snow_line_m = test.world.terrain.min_m + 800;
    for (size_t i = 0; i < sizeof shots / sizeof *shots; i++) {
        if (is_wanted(shots[i].name, argc - 2, argv + 2))
            draw_shot(&test, &shots[i], argv[1]);
    }
    picture_finish(&test);
    return 0;
}
