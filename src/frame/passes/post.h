/* post.h: metering, exposure, tone mapping, encoding: radiance to display. */
#ifndef WD_FRAME_PASSES_POST_H
#define WD_FRAME_PASSES_POST_H

#include "frame/passes/bloom.h"

enum wd_tone { WD_TONE_PLAIN, WD_TONE_BLOOM, WD_TONE_VIEW, WD_TONE_KINDS }; /* VIEW: neither exposed nor toned */

struct wd_post_pass {
    struct wd_pipeline meter, exposure, tonemap[WD_TONE_KINDS];
    struct wd_bloom_pass bloom;
    struct wd_buffer histogram; /* struct wd_meter */
};

bool wd_post_pass_init(struct wd_post_pass *pass, struct wd_gpu *gpu);
void wd_post_pass_finish(struct wd_post_pass *pass, struct wd_gpu *gpu);

struct wd_post_params {
    struct wd_targets *targets;
    struct wd_binding uniforms; /* struct wd_frame_uniforms; exposure 0: by metering */
    float exposure_ev;          /* added to either */
    float bloom;                /* share of the light that the lens spreads */
    uint32_t view_mode;         /* WD_MODE_* */
};
/* Turns targets->radiance into targets->display. View modes other than WD_MODE_LIT are encoded
 * without exposure and tone curve. */
void wd_post_pass_record(struct wd_post_pass *pass, struct wd_cmd *cmd,
                         const struct wd_post_params *params);

#endif
