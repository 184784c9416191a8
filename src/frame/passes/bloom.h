/* bloom.h: light that a lens spreads about bright places. */
#ifndef WD_FRAME_PASSES_BLOOM_H
#define WD_FRAME_PASSES_BLOOM_H

#include "frame/targets.h"

struct wd_bloom_pass {
    struct wd_pipeline first, down, up;
    struct wd_buffer pyramid; /* float[4] a texel: shared/bloom.h; as large as the last picture asks */
};

bool wd_bloom_pass_init(struct wd_bloom_pass *pass, struct wd_gpu *gpu);
void wd_bloom_pass_finish(struct wd_bloom_pass *pass, struct wd_gpu *gpu);

/* Fills the pyramid from targets->radiance, a storage image in use for compute; afterwards its
 * first level holds the sum of all. */
void wd_bloom_pass_record(struct wd_bloom_pass *pass, struct wd_cmd *cmd,
                          struct wd_targets *targets);

#endif
