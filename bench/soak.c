/* Pictures of random views, sizes, methods and times, scenes loaded anew and devices taken away, until
 * the time is over, under Vulkan's validation unless told not to; then whether memory has grown.
 *   soak SECONDS [GPU [no-validation]]   (from the folder of the sources) */
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "weald/renderer.h"

static const char *const SCENES[] = {"tests/api/small.json", "tests/viewer/tiny.json"};
static const char *const METHODS[] = {"continuum", "continuum", "continuum", "octree", "separate"};
enum { SCENE_COUNT = 2, METHOD_COUNT = 5, PICTURES = 12, RELOADS = 3 };

struct soak {
    const char *gpu;
    enum wd_validation validation;
    uint32_t random;
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    uint64_t pictures, scenes, devices;
};

static uint32_t next_random(struct soak *soak, uint32_t below)
{
    soak->random ^= soak->random << 13;
    soak->random ^= soak->random >> 17;
    soak->random ^= soak->random << 5;
    return soak->random % below;
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Between rounds, when the program holds nothing and free blocks have gone back to the system. */
struct memory {
    double resident_mb;
    double used_mb;  /* blocks in use: of libraries that keep, or lose, something */
    double code_mb;  /* made at run time */
    double files_mb; /* of programs and libraries, as far as they were read */
};

static struct memory memory_now(void)
{
    struct memory memory = {0};
    char line[512], permissions[8] = "";
    bool is_file = false;
    malloc_trim(0);
    FILE *file = fopen("/proc/self/smaps", "r");
    while (file && fgets(line, sizeof line, file)) {
        unsigned long from, to, node;
        double kb;
        if (sscanf(line, "%lx-%lx %7s %*s %*s %lu", &from, &to, permissions, &node) == 4)
            is_file = node != 0;
        else if (sscanf(line, "Rss: %lf kB", &kb) == 1) {
            memory.resident_mb += kb * 1.024e-3;
            if (is_file)
                memory.files_mb += kb * 1.024e-3;
            else if (strchr(permissions, 'x'))
                memory.code_mb += kb * 1.024e-3;
        }
    }
    if (file)
        fclose(file);
    struct mallinfo2 info = mallinfo2();
    memory.used_mb = (double)(info.uordblks + info.hblkhd) / 1e6;
    return memory;
}

static bool open_device(struct soak *soak)
{
    const struct wd_renderer_params params = {.gpu = soak->gpu, .validation = soak->validation};
    soak->devices++;
    return wd_renderer_create(&soak->renderer, &params) == WD_OK;
}

/* In place of the scene before. */
static bool load_scene(struct soak *soak, uint32_t index)
{
    const struct wd_forest_params params = {.scene_path = SCENES[index]};
    if (wd_renderer_set_forest(soak->renderer, NULL) != WD_OK)
        return false;
    wd_forest_destroy(&soak->forest);
    soak->scenes++;
    return wd_forest_create(&soak->forest, &params) == WD_OK &&
           wd_renderer_set_forest(soak->renderer, soak->forest) == WD_OK;
}

static bool draw_picture(struct soak *soak)
{
    struct wd_render_params params = {
        .width = 32 + next_random(soak, 300),
        .height = 32 + next_random(soak, 200),
        .samples = 1 + next_random(soak, 2),
        .time_s = 0.01 * next_random(soak, 10000),
        .method = METHODS[next_random(soak, METHOD_COUNT)],
        .accumulation = next_random(soak, 2) ? WD_ACCUMULATE : WD_ACCUMULATE_NOT,
        .layers = next_random(soak, 4) ? WD_LAYER_DISPLAY
                                       : WD_LAYER_ALL | WD_LAYER_CRYPTOMATTE,
    };
    struct wd_picture picture;
    if (next_random(soak, 3) == 0)
        params.max_error_px = 0.5 + next_random(soak, 16);
    if (wd_forest_get_camera(soak->forest, NULL, &params.camera) != WD_OK)
        return false;
    for (int k = 0; k < 2; k++)
        params.camera.position_m[k] += (double)next_random(soak, 200) - 100.0;
    params.camera.position_m[2] += next_random(soak, 100);
    params.camera.yaw_rad = 0.01 * next_random(soak, 628);
    params.camera.pitch_rad = -0.01 * next_random(soak, 100);
    bool ok = wd_renderer_render(soak->renderer, &params, &picture) == WD_OK;
    wd_picture_finish(&picture);
    soak->pictures += ok;
    return ok;
}

/* All that can happen, once over; then nothing is left but the program itself. */
static bool run_round(struct soak *soak, double *device_mb)
{
    struct wd_frame_stats stats;
    bool ok = open_device(soak);
    *device_mb = 0.0;
    for (uint32_t reload = 0; ok && reload < RELOADS; reload++) {
        ok = load_scene(soak, reload % SCENE_COUNT);
        for (int i = 0; ok && i < PICTURES; i++)
            ok = draw_picture(soak);
        wd_renderer_get_stats(soak->renderer, &stats);
        *device_mb = (double)stats.device_bytes / 1e6 > *device_mb
                         ? (double)stats.device_bytes / 1e6
                         : *device_mb;
    }
    wd_renderer_destroy(&soak->renderer); /* as after a loss: a new one goes on */
    wd_forest_destroy(&soak->forest);
    return ok;
}

int main(int argc, char **argv)
{
    double seconds = argc > 1 ? atof(argv[1]) : 0.0, begin_s = now_s(), printed_s = 0.0;
    struct soak soak = {.gpu = argc > 2 ? argv[2] : "software", .random = 0x9e3779b9u,
                        .validation = argc > 3 && !strcmp(argv[3], "no-validation")
                                          ? WD_VALIDATION_OFF : WD_VALIDATION_ON};
    double half_mb = 0.0, last_mb = 0.0, half_device_mb = 0.0, most_device_mb = 0.0;
    uint64_t rounds = 0;
    if (!(seconds > 0.0)) {
        fprintf(stderr, "usage: soak SECONDS [GPU [no-validation]]\n");
        return 2;
    }
    while (rounds < 4 || now_s() - begin_s < seconds) {
        double device_mb, past_s;
        if (!run_round(&soak, &device_mb))
            return 1;
        rounds++;
        struct memory memory = memory_now();
        last_mb = memory.resident_mb;
        past_s = now_s() - begin_s;
        bool early = past_s < 0.5 * seconds || rounds <= 2;
        half_mb = early && last_mb > half_mb ? last_mb : half_mb;
        half_device_mb = early && device_mb > half_device_mb ? device_mb : half_device_mb;
        most_device_mb = device_mb > most_device_mb ? device_mb : most_device_mb;
        if (past_s - printed_s > seconds / 10) {
            printf("%6.0f s: %llu rounds, %llu pictures, host %.1f MB (blocks in use %.2f, "
                   "code %.2f, files %.1f), device %.0f MB\n", past_s, (unsigned long long)rounds,
                   (unsigned long long)soak.pictures, last_mb, memory.used_mb, memory.code_mb,
                   memory.files_mb, device_mb);
            fflush(stdout);
            printed_s = past_s;
        }
    }
    printf("%llu pictures, %llu scenes, %llu devices, no validation error; device at most %.0f MB, %.0f "
           "in the first half\n",
           (unsigned long long)soak.pictures, (unsigned long long)soak.scenes,
           (unsigned long long)soak.devices, most_device_mb, half_device_mb);
    printf("host %.1f MB at the end, at most %.1f in the first half\n", last_mb, half_mb);
    printf("soak %.1f MB\n", last_mb > half_mb ? last_mb - half_mb : 0.0);
    return 0;
}
