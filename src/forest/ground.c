#include "forest/ground.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/log.h"
#include "base/memory.h"
#include "world/cover.h"

static const uint32_t MAX_SLOPES_SIDE = 4096; /* texels; every device can do this */

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static float height_at(const struct wd_terrain *terrain, uint32_t column, uint32_t row)
{
    return terrain->height_m[(size_t)row * terrain->width + column];
}

/* --- pyramid ------------------------------------------------------------------------------ */

static struct wd_height_range patch_range(const struct wd_terrain *terrain, uint32_t column,
                                          uint32_t row)
{
    uint32_t last_column = min_u32(column + WD_PATCH_CELLS, terrain->width - 1);
    uint32_t last_row = min_u32(row + WD_PATCH_CELLS, terrain->height - 1);
    struct wd_height_range range = {INFINITY, -INFINITY};
    for (uint32_t j = row; j <= last_row; j++) {
        for (uint32_t i = column; i <= last_column; i++) {
            range.min_m = fminf(range.min_m, height_at(terrain, i, j));
            range.max_m = fmaxf(range.max_m, height_at(terrain, i, j));
        }
    }
    return range;
}

static void build_finest(struct wd_ground *ground)
{
    const struct wd_terrain *terrain = ground->terrain;
    struct wd_ground_level *level = &ground->levels[0];
    level->columns = (terrain->width - 2) / WD_PATCH_CELLS + 1;
    level->rows = (terrain->height - 2) / WD_PATCH_CELLS + 1;
    level->ranges = wd_alloc_array((size_t)level->columns * level->rows, sizeof *level->ranges);
    for (uint32_t j = 0; j < level->rows; j++) {
        for (uint32_t i = 0; i < level->columns; i++)
            level->ranges[(size_t)j * level->columns + i] =
                patch_range(terrain, i * WD_PATCH_CELLS, j * WD_PATCH_CELLS);
    }
}

static void build_coarser(struct wd_ground_level *level, const struct wd_ground_level *finer)
{
    level->columns = (finer->columns + 1) / 2;
    level->rows = (finer->rows + 1) / 2;
    level->ranges = wd_alloc_array((size_t)level->columns * level->rows, sizeof *level->ranges);
    for (uint32_t i = 0; i < level->columns * level->rows; i++)
        level->ranges[i] = (struct wd_height_range){INFINITY, -INFINITY};
    for (uint32_t j = 0; j < finer->rows; j++) {
        for (uint32_t i = 0; i < finer->columns; i++) {
            const struct wd_height_range *from = &finer->ranges[(size_t)j * finer->columns + i];
            struct wd_height_range *to = &level->ranges[(size_t)(j / 2) * level->columns + i / 2];
            to->min_m = fminf(to->min_m, from->min_m);
            to->max_m = fmaxf(to->max_m, from->max_m);
        }
    }
}

/* Root mean square by which samples that level k leaves out stray from the line between those it
 * keeps, over a subset of rows. */
static float step_error(const struct wd_terrain *terrain, uint32_t level)
{
    uint32_t half = 1u << (level - 1), step = 1u << level;
    uint32_t row_step = step * (terrain->height / (step * 128) + 1);
    double sum = 0;
    uint64_t count = 0;
    for (uint32_t j = 0; j < terrain->height; j += row_step) {
        for (uint32_t i = 0; i + step < terrain->width; i += step) {
            double middle = 0.5 * (height_at(terrain, i, j) + height_at(terrain, i + step, j));
            double stray = height_at(terrain, i + half, j) - middle;
            sum += stray * stray;
            count++;
        }
    }
    return count ? (float)sqrt(sum / (double)count) : 0;
}

static void build_pyramid(struct wd_ground *ground)
{
    build_finest(ground);
    uint32_t top = 0;
    while (top + 1 < WD_TERRAIN_LEVELS &&
           (ground->levels[top].columns > 1 || ground->levels[top].rows > 1)) {
        top++;
        build_coarser(&ground->levels[top], &ground->levels[top - 1]);
        ground->levels[top].error_m =
            ground->levels[top - 1].error_m + 2.0f * step_error(ground->terrain, top);
    }
    ground->level_count = top + 1;
}

/* --- images and buffers --------------------------------------------------------------------- */

/* Rise over run at a sample by differences over `step` samples to either side. */
static void slope_at(const struct wd_terrain *terrain, uint32_t i, uint32_t j, uint32_t step,
                     float slope[2])
{
    uint32_t west = i > step ? i - step : 0, east = min_u32(i + step, terrain->width - 1);
    uint32_t south = j > step ? j - step : 0, north = min_u32(j + step, terrain->height - 1);
    double run_x = (east - west) * terrain->cell_m, run_y = (north - south) * terrain->cell_m;
    slope[0] = (float)((height_at(terrain, east, j) - height_at(terrain, west, j)) / run_x);
    slope[1] = (float)((height_at(terrain, i, north) - height_at(terrain, i, south)) / run_y);
}

/* A grid of `channels` floats, halved in place by box; odd last rows and columns stand for two. */
static void halve(float *values, uint32_t *width, uint32_t *height, uint32_t channels)
{
    uint32_t w = *width > 1 ? *width / 2 : 1, h = *height > 1 ? *height / 2 : 1;
    for (uint32_t j = 0; j < h; j++) {
        for (uint32_t i = 0; i < w; i++) {
            size_t row0 = (size_t)min_u32(2 * j, *height - 1) * *width;
            size_t row1 = (size_t)min_u32(2 * j + 1, *height - 1) * *width;
            uint32_t column0 = min_u32(2 * i, *width - 1), column1 = min_u32(2 * i + 1, *width - 1);
            for (uint32_t c = 0; c < channels; c++) {
                float sum = values[(row0 + column0) * channels + c] +
                            values[(row0 + column1) * channels + c] +
                            values[(row1 + column0) * channels + c] +
                            values[(row1 + column1) * channels + c];
                values[((size_t)j * w + i) * channels + c] = 0.25f * sum;
            }
        }
    }
    *width = w;
    *height = h;
}

/* Uploads all mips of an image of two halves or four (0..1) bytes; spoils `values`. */
static bool upload_mips(struct wd_image *image, struct wd_gpu *gpu, float *values)
{
    bool halves = image->format == VK_FORMAT_R16G16_SFLOAT;
    const uint32_t channels = halves ? 2 : 4;
    uint32_t width = image->width, height = image->height;
    size_t texel = wd_format_texel_bytes(image->format);
    uint8_t *bytes = wd_alloc_array((size_t)width * height, texel);
    bool ok = true;
    for (uint32_t mip = 0; mip < image->mips && ok; mip++) {
        size_t count = (size_t)width * height * channels;
        for (size_t i = 0; i < count; i++) {
            if (halves)
                memcpy(bytes + 2 * i, &(uint16_t){wd_half_of(values[i])}, 2);
            else
                bytes[i] = (uint8_t)(255.0f * values[i] + 0.5f);
        }
        ok = wd_image_upload(gpu, image, 0, mip, bytes, (size_t)width * height * texel);
        halve(values, &width, &height, channels);
    }
    free(bytes);
    return ok;
}

static bool make_image(struct wd_image *image, struct wd_gpu *gpu, const char *name,
                       VkFormat format, uint32_t width, uint32_t height)
{
    const struct wd_image_params params = {
        .name = name,
        .format = format,
        .width = width,
        .height = height,
        .mips = WD_ALL_MIPS,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
    };
    return wd_image_init(image, gpu, &params);
}

static bool upload_slopes(struct wd_ground *ground, struct wd_gpu *gpu)
{
    const struct wd_terrain *terrain = ground->terrain;
    uint32_t longest = terrain->width > terrain->height ? terrain->width : terrain->height;
    uint32_t step = ground->slopes_step = (longest - 1) / MAX_SLOPES_SIDE + 1;
    uint32_t width = (terrain->width - 1) / step + 1, height = (terrain->height - 1) / step + 1;
    float *slopes = wd_alloc_array((size_t)width * height, 2 * sizeof *slopes);
    for (uint32_t j = 0; j < height; j++) {
        for (uint32_t i = 0; i < width; i++)
            slope_at(terrain, i * step, j * step, step, slopes + 2 * ((size_t)j * width + i));
    }
    bool ok = make_image(&ground->slopes, gpu, "ground slopes", VK_FORMAT_R16G16_SFLOAT, width,
                         height) &&
              upload_mips(&ground->slopes, gpu, slopes);
    free(slopes);
    return ok;
}

/* Cover, the woods about a place, and a quarter of the layers of its sward. A world without cover (no trees) gets one texel of none. */
static bool upload_cover(struct wd_ground *ground, struct wd_gpu *gpu, const struct wd_world *world)
{
    bool has = world->cover && world->cover_width && world->cover_height;
    uint32_t width = has ? world->cover_width : 1, height = has ? world->cover_height : 1;
    ground->cover_cell_m = has ? world->cover_cell_m : wd_terrain_extent_x_m(ground->terrain);
    float *cover = wd_alloc_array((size_t)width * height, 4 * sizeof *cover);
    for (size_t i = 0; has && i < (size_t)width * height; i++) {
        double x_m = ((double)(i % width) + 0.5) * ground->cover_cell_m;
        double y_m = ((double)(i / width) + 0.5) * ground->cover_cell_m;
        cover[4 * i] = (float)world->cover[i] / 255.0f;
        cover[4 * i + 1] = wd_woods_at(world, x_m, y_m);
        cover[4 * i + 2] = world->sward ? fminf(world->sward[i] / (4.0f * WD_SWARD_LAYER), 1) : 0;
    }
    bool ok = make_image(&ground->cover, gpu, "canopy cover", VK_FORMAT_R8G8B8A8_UNORM, width,
                         height) &&
              upload_mips(&ground->cover, gpu, cover);
    free(cover);
    return ok;
}

static bool make_buffer(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                        VkDeviceSize size)
{
    VkDeviceSize most = gpu->properties.limits.maxStorageBufferRange;
    if (size > most)
        return wd_error(gpu->log, "%s: %llu MB are more than the %llu MB that %s can bind at once",
                        name, (unsigned long long)(size >> 20), (unsigned long long)(most >> 20),
                        gpu->properties.deviceName);
    const struct wd_buffer_params params = {
        .name = name, .size = size, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    return wd_buffer_init(buffer, gpu, &params);
}

static bool upload_samples(struct wd_ground *ground, struct wd_gpu *gpu)
{
    const struct wd_terrain *terrain = ground->terrain;
    size_t count = (size_t)terrain->width * terrain->height;
    size_t hole_bytes = terrain->hole ? (count + 3) & ~(size_t)3 : 4;
    const uint8_t none[4] = {0};
    size_t water_bytes = terrain->water_m ? count * sizeof(float) : sizeof none;
    return make_buffer(&ground->heights, gpu, "terrain heights", count * sizeof(float)) &&
           wd_buffer_upload(gpu, &ground->heights, 0, terrain->height_m, count * sizeof(float)) &&
           make_buffer(&ground->holes, gpu, "terrain holes", hole_bytes) &&
           wd_buffer_upload(gpu, &ground->holes, 0, terrain->hole ? terrain->hole : none,
                            terrain->hole ? count : sizeof none) &&
           make_buffer(&ground->waters, gpu, "waters", water_bytes) &&
           wd_buffer_upload(gpu, &ground->waters, 0,
                            terrain->water_m ? (const void *)terrain->water_m : none, water_bytes);
}

bool wd_ground_init(struct wd_ground *ground, struct wd_gpu *gpu, const struct wd_world *world,
                    const struct wd_log *log)
{
    *ground = (struct wd_ground){.terrain = &world->terrain};
    build_pyramid(ground);
    bool ok = upload_samples(ground, gpu) && upload_slopes(ground, gpu) &&
              upload_cover(ground, gpu, world) &&
              wd_sampler_init(&ground->sampler, gpu, WD_SAMPLER_TRILINEAR_CLAMP);
    if (!ok) {
        wd_ground_finish(ground, gpu);
        return false;
    }
    wd_debug(log, "ground: %u levels of patches, slopes every %u samples", ground->level_count,
             ground->slopes_step);
    return true;
}

void wd_ground_finish(struct wd_ground *ground, struct wd_gpu *gpu)
{
    wd_buffer_finish(&ground->heights, gpu);
    wd_buffer_finish(&ground->holes, gpu);
    wd_buffer_finish(&ground->waters, gpu);
    wd_image_finish(&ground->slopes, gpu);
    wd_image_finish(&ground->cover, gpu);
    if (ground->sampler)
        vkDestroySampler(gpu->device, ground->sampler, NULL);
    for (uint32_t i = 0; i < WD_TERRAIN_LEVELS; i++)
        free(ground->levels[i].ranges);
    *ground = (struct wd_ground){0};
}

static uint32_t patch_at(double at_m, double side_m, uint32_t count)
{
    double at = floor(at_m / side_m);
    return at < 0.0 ? 0 : at >= count ? count - 1 : (uint32_t)at;
}

struct wd_height_range wd_ground_range(const struct wd_ground *ground, const double min_m[2],
                                       const double max_m[2])
{
    uint32_t k = 0;
    double side_m = WD_PATCH_CELLS * ground->terrain->cell_m;
    double longest = fmax(max_m[0] - min_m[0], max_m[1] - min_m[1]);
    for (; k + 1 < ground->level_count && side_m < longest; k++)
        side_m *= 2.0;
    const struct wd_ground_level *level = &ground->levels[k];
    struct wd_height_range range = {INFINITY, -INFINITY};
    for (uint32_t j = patch_at(min_m[1], side_m, level->rows);
         j <= patch_at(max_m[1], side_m, level->rows); j++) {
        for (uint32_t i = patch_at(min_m[0], side_m, level->columns);
             i <= patch_at(max_m[0], side_m, level->columns); i++) {
            const struct wd_height_range *part = &level->ranges[(size_t)j * level->columns + i];
            range.min_m = fminf(range.min_m, part->min_m);
            range.max_m = fmaxf(range.max_m, part->max_m);
        }
    }
    return range;
}

void wd_ground_use(struct wd_ground *ground, struct wd_cmd *cmd)
{
    wd_cmd_use_buffer(cmd, &ground->heights, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &ground->holes, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &ground->waters, WD_USE_SHADER_READ);
    wd_cmd_use_image(cmd, &ground->slopes, WD_USE_SHADER_READ);
    wd_cmd_use_image(cmd, &ground->cover, WD_USE_SHADER_READ);
}
