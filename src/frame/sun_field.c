#include "frame/sun_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static const uint32_t MAX_SIDE = 2048;
/* Under the ground, where nothing stands toward the sun; more where its shadows are softer. */
static const float FAR_BELOW_M = 50.0f;

float wd_sun_field_soft_m(float cell_m, float rise)
{
    return 0.45f * cell_m * fmaxf(rise, 0.02f);
}

/* A place is hidden up to what its neighbour toward the sun is hidden to, or that neighbour's own
 * height, less what the sun's ray falls on the way. Going from the sun's side over the axis that
 * the sun's direction follows more, the neighbour lies between two samples of the row before. */
void wd_sun_field_sweep(float *out, const float *height_m, uint32_t width, uint32_t height,
                        float cell_m, float toward_x, float toward_y, float rise)
{
    bool along_y = fabsf(toward_y) >= fabsf(toward_x);
    float major = along_y ? toward_y : toward_x, minor = along_y ? toward_x : toward_y;
    uint32_t lines = along_y ? height : width, length = along_y ? width : height;
    ptrdiff_t line_step = along_y ? (ptrdiff_t)width : 1, step = along_y ? 1 : (ptrdiff_t)width;
    ptrdiff_t toward = major > 0 ? line_step : -line_step;
    float aside = fabsf(major) > 0 ? minor / fabsf(major) : 0; /* samples, -1..1 */
    float fall = cell_m * sqrtf(1 + aside * aside) * rise;
    float below = fmaxf(FAR_BELOW_M, wd_sun_field_soft_m(cell_m, rise));
    int32_t whole = (int32_t)floorf(aside);
    float share = aside - (float)whole;
    for (uint32_t n = 0; n < lines; n++) {
        uint32_t line = major > 0 ? lines - 1 - n : n;
        const float *ground = height_m + line * line_step;
        float *row = out + line * line_step;
        for (uint32_t i = 0; i < length; i++) {
            int32_t a = (int32_t)i + whole, b = a + 1;
            float *at = row + (ptrdiff_t)i * step;
            if (n == 0 || a < 0 || b >= (int32_t)length) {
                *at = ground[(ptrdiff_t)i * step] - below;
                continue;
            }
            const float *ga = ground + a * step + toward, *gb = ground + b * step + toward;
            const float *sa = row + a * step + toward, *sb = row + b * step + toward;
            float first = fmaxf(*ga, *sa), second = fmaxf(*gb, *sb);
            *at = first + share * (second - first) - fall;
        }
    }
}

static bool is_current(const struct wd_sun_field *field, const struct wd_terrain *terrain,
                       const float sun_direction[3])
{
    return field->heights.buffer && field->terrain == terrain &&
           memcmp(field->direction, sun_direction, sizeof field->direction) == 0;
}

static uint32_t samples_at(uint32_t samples, uint32_t step)
{
    uint32_t count = (samples - 1) / step + 1;
    return count < 2 ? 2 : count;
}

/* Every step-th sample; the last ones stand for what the step leaves over. */
static float *thinned(const struct wd_terrain *terrain, uint32_t step, uint32_t width,
                      uint32_t height)
{
    float *heights = wd_alloc_array((size_t)width * height, sizeof *heights);
    for (uint32_t j = 0; j < height; j++) {
        uint32_t row = j * step < terrain->height ? j * step : terrain->height - 1;
        for (uint32_t i = 0; i < width; i++) {
            uint32_t column = i * step < terrain->width ? i * step : terrain->width - 1;
            heights[(size_t)j * width + i] =
                terrain->height_m[(size_t)row * terrain->width + column];
        }
    }
    return heights;
}

static bool resize(struct wd_sun_field *field, struct wd_cmd *cmd, uint32_t width, uint32_t height)
{
    const struct wd_buffer_params params = {
        .name = "sun field",
        .size = (VkDeviceSize)width * height * sizeof(float),
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        .texels = VK_FORMAT_R32_SFLOAT,
    };
    field->width = width;
    field->height = height;
    if (field->heights.size == params.size)
        return true;
    wd_cmd_defer_buffer(cmd, &field->heights);
    return wd_buffer_init(&field->heights, cmd->gpu, &params);
}

static void copy_in(struct wd_sun_field *field, struct wd_cmd *cmd, const struct wd_binding *from)
{
    wd_cmd_use_buffer(cmd, &field->heights, WD_USE_TRANSFER_WRITE);
    const VkBufferCopy region = {.srcOffset = from->offset, .size = field->heights.size};
    vkCmdCopyBuffer(cmd->vk, from->buffer->buffer, field->heights.buffer, 1, &region);
}

static void rebuild(struct wd_sun_field *field, struct wd_cmd *cmd,
                    const struct wd_terrain *terrain, const float direction[3])
{
    uint32_t longest = terrain->width > terrain->height ? terrain->width : terrain->height;
    uint32_t step = (longest - 1) / MAX_SIDE + 1;
    uint32_t width = samples_at(terrain->width, step), height = samples_at(terrain->height, step);
    struct wd_binding upload;
    float *swept = wd_cmd_upload(cmd, (VkDeviceSize)width * height * sizeof *swept, &upload);
    if (!swept || !resize(field, cmd, width, height)) {
        cmd->failed = true;
        return;
    }
    float across = fmaxf(hypotf(direction[0], direction[1]), 1e-4f);
    float rise = direction[2] / across;
    field->terrain = terrain;
    field->cell_m = (float)(step * terrain->cell_m);
    field->soft_m = wd_sun_field_soft_m(field->cell_m, rise);
    memcpy(field->direction, direction, sizeof field->direction);
    float *heights = thinned(terrain, step, width, height);
    /* of its own: the sweep reads what it has written, which upload memory is slow to give back */
    float *out = wd_alloc_array((size_t)width * height, sizeof *out);
    wd_sun_field_sweep(out, heights, width, height, field->cell_m, direction[0] / across,
                       direction[1] / across, rise);
    memcpy(swept, out, (size_t)width * height * sizeof *swept);
    free(heights);
    free(out);
    copy_in(field, cmd, &upload);
}

void wd_sun_field_update(struct wd_sun_field *field, struct wd_cmd *cmd,
                         const struct wd_terrain *terrain, const float sun_direction[3])
{
    if (!is_current(field, terrain, sun_direction))
        rebuild(field, cmd, terrain, sun_direction);
    if (field->heights.buffer)
        wd_cmd_use_buffer(cmd, &field->heights, WD_USE_COMPUTE_READ);
}

void wd_sun_field_forget(struct wd_sun_field *field)
{
    field->terrain = NULL;
}

void wd_sun_field_finish(struct wd_sun_field *field, struct wd_gpu *gpu)
{
    wd_buffer_finish(&field->heights, gpu);
    *field = (struct wd_sun_field){0};
}
