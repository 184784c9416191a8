#include "frame/frame.h"

#include <math.h>
#include <string.h>

#include "frame/uniforms.h"
#include "shared/wind.h"

bool wd_frame_init(struct wd_frame *frame, struct wd_gpu *gpu)
{
    *frame = (struct wd_frame){.gpu = gpu};
    bool ok = wd_frames_init(&frame->ring, gpu) && wd_tree_pipelines_init(&frame->trees, gpu) &&
              wd_terrain_pass_init(&frame->terrain, gpu) &&
              wd_light_pass_init(&frame->light, gpu) && wd_post_pass_init(&frame->post, gpu) &&
              wd_accumulate_pass_init(&frame->accumulate, gpu);
    if (!ok)
        wd_frame_finish(frame);
    return ok;
}

void wd_frame_finish(struct wd_frame *frame)
{
    if (!frame->gpu)
        return;
    wd_frames_finish(&frame->ring);
    wd_terrain_pass_finish(&frame->terrain, frame->gpu);
    wd_light_pass_finish(&frame->light, frame->gpu);
    wd_post_pass_finish(&frame->post, frame->gpu);
    wd_accumulate_pass_finish(&frame->accumulate, frame->gpu);
    wd_targets_finish(&frame->targets, frame->gpu);
    wd_buffer_finish(&frame->velocity_px, frame->gpu);
    wd_methods_finish(&frame->methods, frame->gpu);
    *frame = (struct wd_frame){0};
}

static bool prepare_velocity(struct wd_frame *frame)
{
    VkDeviceSize size =
        (VkDeviceSize)frame->targets.width * frame->targets.height * 2 * sizeof(float);
    const struct wd_buffer_params params = {"velocity", size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            WD_MEMORY_DEVICE};
    if (frame->params.velocity == WD_VELOCITY_OFF || frame->velocity_px.size == size)
        return true;
    if (!wd_frames_wait(&frame->ring))
        return false;
    wd_buffer_finish(&frame->velocity_px, frame->gpu);
    return wd_buffer_init(&frame->velocity_px, frame->gpu, &params);
}

/* Begins anew where something else is to be gathered; else what was gathered last becomes the frame before. */
static void prepare_gathering(struct wd_frame *frame)
{
    struct wd_frame_params *params = &frame->params;
    struct wd_gathered *gathered = &frame->gathered;
    if (params->gathering == WD_GATHER_OFF || gathered->method != params->method ||
        gathered->view_mode != params->view_mode || gathered->sun.azimuth_deg != params->sun.azimuth_deg ||
        gathered->sun.elevation_deg != params->sun.elevation_deg || frame->accumulate.width != params->width ||
        frame->accumulate.height != params->height) {
        wd_accumulate_pass_reset(&frame->accumulate);
        *gathered = (struct wd_gathered){.method = params->method, .view_mode = params->view_mode, .sun = params->sun};
    }
    if (params->gathering == WD_GATHER_OFF)
        return;
    params->samples = 1;
    params->velocity = WD_VELOCITY_ON;
    params->previous_camera = gathered->frames ? gathered->camera : params->camera;
    params->previous_time_s = gathered->frames ? gathered->time_s : params->time_s;
}

static enum wd_leaf_kinds leaves_of(const struct wd_method *method)
{
    return method->single_leaves ? WD_LEAVES_SINGLE : WD_LEAVES_ANY;
}

static bool prepare_pipelines(struct wd_frame *frame)
{
    const struct wd_frame_params *params = &frame->params;
    const struct wd_light_needs needs = {params->forest, params->view_mode,
                                         leaves_of(params->method), params->width, params->height};
    return wd_tree_pipelines_prepare(&frame->trees, frame->gpu, params->forest,
                                     params->method->cards) &&
           wd_terrain_pass_prepare(&frame->terrain, frame->gpu, &params->forest->ground) &&
           (params->light == WD_FRAME_UNLIT || wd_light_pass_prepare(&frame->light, frame->gpu, &needs));
}

/* Pictures of WD_FINE_SAMPLES and more draw their shadow maps once for all, and show finer shadows than one
 * sample does: their maps are twice as wide, up to so many texels. FLIP of trees of 256 px falls by 0.016. */
enum { FINE_TEXELS = 2048 };

static uint32_t shadow_size_of(const struct wd_frame_params *params)
{
    uint32_t size = (uint32_t)params->forest->scene->quality.shadow_size;
    if (params->samples < WD_FINE_SAMPLES || size >= FINE_TEXELS)
        return size;
    return 2 * size < FINE_TEXELS ? 2 * size : FINE_TEXELS;
}

bool wd_frame_prepare(struct wd_frame *frame, const struct wd_frame_params *params)
{
    struct wd_targets *targets = &frame->targets;
    uint32_t shadow_size = shadow_size_of(params);
    frame->params = *params;
    prepare_gathering(frame);
    if (targets->width != params->width || targets->height != params->height ||
        targets->shadow_size != shadow_size) {
        if (!wd_frames_wait(&frame->ring))
            return false;
        wd_targets_finish(targets, frame->gpu);
        memset(frame->kept, 0, sizeof frame->kept);
        if (!wd_targets_init(targets, frame->gpu, params->width, params->height, shadow_size))
            return false;
    }
    frame->method_state = wd_methods_open(&frame->methods, frame->gpu, params->method,
                                          params->forest);
    return frame->method_state && prepare_pipelines(frame) && prepare_velocity(frame);
}

static void forget_pictures(struct wd_frame *frame)
{
    memset(frame->kept, 0, sizeof frame->kept);
    wd_accumulate_pass_reset(&frame->accumulate);
    frame->gathered = (struct wd_gathered){0};
}

void wd_frame_abandoned(struct wd_frame *frame)
{
    forget_pictures(frame);
    wd_pages_forget(&frame->params.forest->pages);
    wd_methods_forget(&frame->methods);
    wd_light_pass_forget(&frame->light);
}

void wd_frame_drop_forest(struct wd_frame *frame)
{
    forget_pictures(frame);
    wd_methods_drop_forest(&frame->methods, frame->gpu);
    wd_light_pass_drop_forest(&frame->light, frame->gpu);
}

/* --- recording --------------------------------------------------------------------------- */

/* Sub-pixel offsets that gathered frames take in turn. */
enum { GATHERED_OFFSETS = 64 };

/* What the steps of one sample share. */
struct recording {
    struct wd_frame *frame;
    struct wd_cmd *cmd;
    struct wd_view view, cascades[WD_CASCADES];
    struct wd_frame_uniforms values;
    struct wd_binding uniforms;
    uint32_t index; /* of the sample */
};

static struct wd_tree_draw tree_draw_of(const struct recording *r, const struct wd_view *view,
                                        enum wd_tree_pass pass, struct wd_draw_stats *stats)
{
    struct wd_frame *frame = r->frame;
    return (struct wd_tree_draw){
        .cmd = r->cmd,
        .pipelines = &frame->trees,
        .forest = frame->params.forest,
        .view = view,
        .pass = pass,
        .targets = &frame->targets,
        .uniforms = r->uniforms,
        .stats = stats,
        .view_mode = frame->params.view_mode,
        .page_budget = frame->params.page_budget,
        .max_error_px = frame->params.max_error_px,
    };
}

static void add_stats(struct wd_draw_stats *sum, const struct wd_draw_stats *stats)
{
    sum->draw_calls += stats->draw_calls;
    sum->triangles += stats->triangles;
    for (int level = 0; level < 3; level++)
        sum->trees[level] += stats->trees[level];
    sum->unfinished = sum->unfinished || stats->unfinished;
}

static void set_load(struct wd_rendering *targets, enum wd_load load)
{
    for (uint32_t i = 0; i < targets->color_count; i++)
        targets->color[i].load = load;
    targets->depth_load = load;
}

/* The trees of one view, into `targets`; false where more of them are to come. */
static bool record_trees(const struct recording *r, const struct wd_view *view,
                         enum wd_tree_pass pass, struct wd_rendering *targets)
{
    struct wd_frame *frame = r->frame;
    const struct wd_method *method = frame->params.method;
    struct wd_draw_stats stats = {0};
    const struct wd_tree_draw draw = tree_draw_of(r, view, pass, &stats);
    bool trees = wd_world_has_trees(frame->params.forest->world) &&
                 (pass == WD_PASS_CAMERA || r->values.shadow_taps);
    if (trees && method->select)
        method->select(frame->method_state, &draw);
    wd_cmd_scope_begin(r->cmd, "draw");
    enum wd_filled filled = WD_FILLED_NOT;
    if (trees && method->fill)
        filled = method->fill(frame->method_state, &draw);
    if (filled != WD_FILLED_NOT)
        set_load(targets, WD_LOAD_KEEP);
    if (filled != WD_FILLED_LAST) {
        wd_cmd_begin_rendering(r->cmd, targets);
        if (trees)
            method->draw(frame->method_state, &draw);
        wd_cmd_end_rendering(r->cmd);
    }
    if (trees && method->merge)
        method->merge(frame->method_state, &draw);
    wd_cmd_scope_end(r->cmd);
    add_stats(&frame->stats, &stats);
    if (pass == WD_PASS_CAMERA)
        frame->camera_stats = stats;
    return !stats.unfinished;
}

/* Samples that a map's detail goes by: where an error is bounded, those of a frame (continuum). */
static uint32_t detail_samples(const struct wd_frame_params *params)
{
    return params->max_error_px > 0.0f ? 1 : params->samples;
}

static bool is_kept(const struct wd_kept_cascade *kept, const struct wd_frame_params *params,
                    const struct wd_cascade_box *box)
{
    const struct wd_cascade_box *old = &kept->box;
    return kept->method == params->method && kept->samples == detail_samples(params) && box->calm &&
           old->calm && box->radius == old->radius && box->depth == old->depth &&
           !memcmp(box->center, old->center, sizeof box->center) &&
           !memcmp(box->toward, old->toward, sizeof box->toward);
}

/* Continuum's compute takes its depth from parallel maps. */
static enum wd_shadow_maps maps_of(const struct wd_frame_params *params)
{
    return params->method->cascades == WD_CASCADES_KEPT
               ? WD_SHADOW_CASCADES
               : (enum wd_shadow_maps)params->forest->scene->quality.shadow_maps;
}

/* The maps hold what stands on the ground; the ground's own shadows are in the light pass. */
static void record_shadows(const struct recording *r)
{
    struct wd_targets *targets = &r->frame->targets;
    targets->shadow_is_stored = r->frame->params.method->stores_shadow &&
                                wd_world_has_trees(r->frame->params.forest->world) &&
                                targets->stored_shadow.image;
    wd_cmd_scope_begin(r->cmd, "shadow trees");
    uint32_t maps = maps_of(&r->frame->params) == WD_SHADOW_PERSPECTIVE ? 1 : WD_CASCADES;
    for (uint32_t i = 0; i < maps; i++) {
        struct wd_rendering rendering = {
            .width = targets->shadow_size,
            .height = targets->shadow_size,
            .depth = &targets->shadow,
            .depth_view = targets->shadow_layers[i],
            .depth_load = WD_LOAD_CLEAR,
        };
        const struct wd_frame_params *params = &r->frame->params;
        struct wd_kept_cascade *kept = &r->frame->kept[i];
        if (is_kept(kept, params, &r->cascades[i].box))
            continue;
        bool whole = record_trees(r, &r->cascades[i], WD_PASS_SHADOW, &rendering);
        *kept = (struct wd_kept_cascade){.method = whole ? params->method : NULL,
                                         .samples = detail_samples(params),
                                         .box = r->cascades[i].box};
    }
    wd_cmd_scope_end(r->cmd);
}

static void record_terrain(const struct recording *r)
{
    struct wd_frame *frame = r->frame;
    const struct wd_terrain_params terrain = {
        .ground = &frame->params.forest->ground,
        .view = &r->view,
        .uniforms = r->uniforms,
        .error_px = (float)frame->params.forest->scene->quality.terrain_error_px,
    };
    wd_cmd_scope_begin(r->cmd, "terrain");
    const struct wd_rendering targets = wd_terrain_pass_targets(&frame->terrain, &frame->targets);
    wd_cmd_begin_rendering(r->cmd, &targets);
    wd_terrain_pass_record(&frame->terrain, r->cmd, &terrain);
    wd_cmd_end_rendering(r->cmd);
    wd_terrain_pass_shade(&frame->terrain, r->cmd, &terrain, &frame->targets);
    wd_cmd_scope_end(r->cmd);
    frame->stats.draw_calls++;
    frame->stats.triangles += frame->terrain.triangles;
}

static void clear_gbuffer(const struct recording *r)
{
    const struct wd_rendering targets = wd_targets_gbuffer(&r->frame->targets, WD_LOAD_CLEAR);
    wd_cmd_scope_begin(r->cmd, "clear");
    wd_cmd_begin_rendering(r->cmd, &targets);
    wd_cmd_end_rendering(r->cmd);
    wd_cmd_scope_end(r->cmd);
}

static void record_gbuffer(const struct recording *r)
{
    struct wd_frame *frame = r->frame;
    const struct wd_method *method = frame->params.method;
    bool last = method->ground == WD_GROUND_LAST;
    bool clear = !last || !method->fill;
    if (clear)
        clear_gbuffer(r); /* methods may draw on its depth before the rest */
    if (!last)
        record_terrain(r);
    wd_cmd_scope_begin(r->cmd, "trees");
    struct wd_rendering targets =
        wd_targets_gbuffer(&frame->targets, clear ? WD_LOAD_KEEP : WD_LOAD_CLEAR);
    record_trees(r, &r->view, WD_PASS_CAMERA, &targets);
    wd_cmd_scope_end(r->cmd);
    if (last)
        record_terrain(r);
    if (method->keep && wd_world_has_trees(frame->params.forest->world)) {
        struct wd_draw_stats stats = {0};
        const struct wd_tree_draw draw = tree_draw_of(r, &r->view, WD_PASS_CAMERA, &stats);
        wd_cmd_scope_begin(r->cmd, "keep");
        method->keep(frame->method_state, &draw);
        wd_cmd_scope_end(r->cmd);
    }
}

static bool blends(const struct recording *r)
{
    const struct wd_frame_params *params = &r->frame->params;
    return params->method->blend && wd_world_has_trees(params->forest->world) &&
           params->view_mode == WD_MODE_LIT;
}

static bool is_lit(const struct recording *r)
{
    return r->frame->params.light == WD_FRAME_LIT;
}

static bool is_last(const struct recording *r)
{
    return r->index + 1 == r->frame->params.samples;
}

/* Trees that are blended over the rest, back to front. */
static void record_blend(const struct recording *r, const struct wd_light_params *light)
{
    struct wd_frame *frame = r->frame;
    struct wd_draw_stats stats = {0};
    struct wd_light_inputs inputs;
    const struct wd_tree_draw draw = tree_draw_of(r, &r->view, WD_PASS_CAMERA, &stats);
    wd_cmd_scope_begin(r->cmd, "blend trees");
    if (wd_light_pass_inputs(&frame->light, r->cmd, light, &inputs))
        frame->params.method->blend(frame->method_state, &draw, &inputs);
    wd_cmd_scope_end(r->cmd);
    add_stats(&frame->stats, &stats);
    add_stats(&frame->camera_stats, &stats);
}

/* Blended trees, where the G-buffer is read afterwards. */
static void record_layers(const struct recording *r)
{
    struct wd_frame *frame = r->frame;
    enum wd_gbuffer_use use = frame->params.gbuffer;
    if (!blends(r) || !(use == WD_GBUFFER_READ_EACH || (use == WD_GBUFFER_READ && is_last(r))))
        return;
    struct wd_draw_stats stats = {0};
    const struct wd_tree_draw draw = tree_draw_of(r, &r->view, WD_PASS_CAMERA, &stats);
    const struct wd_rendering targets = wd_targets_gbuffer(&frame->targets, WD_LOAD_KEEP);
    wd_cmd_scope_begin(r->cmd, "tree layers");
    wd_cmd_begin_rendering(r->cmd, &targets);
    frame->params.method->draw_layers(frame->method_state, &draw);
    wd_cmd_end_rendering(r->cmd);
    wd_cmd_scope_end(r->cmd);
}

static struct wd_light_params light_of(const struct recording *r)
{
    struct wd_frame *frame = r->frame;
    return (struct wd_light_params){
        .targets = &frame->targets,
        .forest = frame->params.forest,
        .view = &r->view,
        .frame = &r->values,
        .uniforms = r->uniforms,
        .overlay = blends(r) ? WD_OVERLAY_OVER : WD_OVERLAY_NONE,
        .leaves = leaves_of(frame->params.method),
        .level_cards = !frame->params.method->eye_pictures,
    };
}

static void record_light(const struct recording *r)
{
    const struct wd_light_params light = light_of(r);
    if (blends(r))
        record_blend(r, &light);
    wd_cmd_scope_begin(r->cmd, "light");
    wd_light_pass_record(&r->frame->light, r->cmd, &light);
    wd_cmd_scope_end(r->cmd);
}

static void record_velocity(const struct recording *r)
{
    struct wd_frame *frame = r->frame;
    const struct wd_light_params light = light_of(r);
    wd_cmd_scope_begin(r->cmd, "velocity");
    wd_light_pass_record_velocity(&frame->light, r->cmd, &light, &frame->velocity_px);
    wd_cmd_scope_end(r->cmd);
}

/* Lays the one sample over those of the frames before. */
static void record_gathering(const struct recording *r)
{
    struct wd_frame *frame = r->frame;
    struct wd_gathered *gathered = &frame->gathered;
    const struct wd_frame_params *params = &frame->params;
    bool still = !memcmp(&params->camera, &params->previous_camera, sizeof params->camera) &&
                 params->time_s == params->previous_time_s;
    const struct wd_accumulate_params accumulate = {
        .targets = &frame->targets,
        .uniforms = r->uniforms,
        .velocity_px = &frame->velocity_px,
        .motion = still ? WD_MOTION_NONE : WD_MOTION_SOME,
    };
    wd_cmd_scope_begin(r->cmd, "accumulate");
    wd_accumulate_pass_record(&frame->accumulate, r->cmd, &accumulate);
    wd_cmd_scope_end(r->cmd);
    gathered->camera = params->camera;
    gathered->time_s = params->time_s;
    gathered->frames++;
}

static void record_display(const struct recording *r)
{
    const struct wd_post_params post = {
        .targets = &r->frame->targets,
        .uniforms = r->uniforms,
        .bloom = (float)r->frame->params.forest->scene->lens.bloom,
        .exposure_ev = (float)r->frame->params.forest->scene->quality.exposure_ev,
        .view_mode = r->frame->params.view_mode,
    };
    wd_cmd_scope_begin(r->cmd, "post");
    wd_post_pass_record(&r->frame->post, r->cmd, &post);
    wd_cmd_scope_end(r->cmd);
}

/* Gusts and ringing move the crowns of the tallest trees by about half of this from where the mean
 * wind bends them; less cannot be told from the grain of the shadow maps. */
static double calm_m(const struct wd_forest_device *forest)
{
    const struct wd_scene *scene = forest->scene;
    float flexibility = 0.0f;
    for (uint32_t i = 0; i < forest->model_count; i++)
        flexibility = fmaxf(flexibility, forest->host_models[i].flexibility);
    double bend_m = (double)(wd_wind_bend(flexibility, (float)scene->wind.speed_mps) * forest->max_tree_height_m);
    return fmax(0.5 * scene->wind.gust * bend_m, 1e-6);
}

static void prepare_recording(struct recording *r, uint32_t index)
{
    const struct wd_frame_params *params = &r->frame->params;
    bool gathers = params->gathering == WD_GATHER_ON;
    const struct wd_uniforms_params uniforms = {
        .forest = params->forest,
        .camera = params->camera,
        .previous_camera = params->previous_camera,
        .sun = params->sun,
        .time_s = params->time_s,
        .previous_time_s = params->previous_time_s,
        .width = params->width,
        .height = params->height,
        .shadow_size = r->frame->targets.shadow_size,
        .samples = params->samples,
        .sample_index = gathers ? r->frame->gathered.frames % GATHERED_OFFSETS : index,
        .sample_count = gathers ? GATHERED_OFFSETS : params->samples,
        .adds = index > 0,
        .view_mode = params->view_mode,
        .maps = maps_of(params),
        .calm_m = params->method->cascades == WD_CASCADES_KEPT ? calm_m(params->forest) : 0.0,
    };
    wd_uniforms_init(&r->values, &r->view, r->cascades, &uniforms);
    r->frame->near_m = r->values.near_m;
    r->frame->stats = (struct wd_draw_stats){0};
    void *memory = wd_cmd_upload(r->cmd, sizeof r->values, &r->uniforms);
    if (memory)
        memcpy(memory, &r->values, sizeof r->values);
}

void wd_frame_record(struct wd_frame *frame, struct wd_cmd *cmd, uint32_t index)
{
    struct recording r = {.frame = frame, .cmd = cmd, .index = index};
    prepare_recording(&r, index);
    if (cmd->failed)
        return;
    wd_forest_device_use(frame->params.forest, cmd);
    if (index == 0 && is_lit(&r))
        record_shadows(&r);
    record_gbuffer(&r);
    if (is_lit(&r))
        record_light(&r);
    record_layers(&r);
    if (is_last(&r) && frame->params.velocity == WD_VELOCITY_ON)
        record_velocity(&r);
    if (frame->params.gathering == WD_GATHER_ON)
        record_gathering(&r);
    if (is_last(&r) && is_lit(&r))
        record_display(&r);
}
