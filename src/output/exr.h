/* exr.h: OpenEXR files with any channels: colour, depth, normals, ids. */
#ifndef WD_OUTPUT_EXR_H
#define WD_OUTPUT_EXR_H

#include "weald/types.h"

enum wd_exr_type { WD_EXR_HALF, WD_EXR_FLOAT, WD_EXR_UINT };

struct wd_exr_channel {
    const char *name;      /* "R", "Z", "N.X", "tree_id"; a dot separates a layer's name */
    enum wd_exr_type type; /* in the file */
    const void *data;      /* float for HALF and FLOAT, uint32_t for UINT; rows from the top */
    uint32_t stride;       /* elements from one pixel to the next; 0: 1 */
};

struct wd_exr_text {
    const char *name, *value;
};

struct wd_exr_params {
    uint32_t width, height;
    const struct wd_exr_channel *channels;
    size_t channel_count;
    const struct wd_exr_text *texts; /* attributes */
    size_t text_count;
    const float *world_to_camera; /* 4 x 4 by rows, the standard attribute of that name; NULL: none */
};

/* ZIP-compressed scan lines; colours are noted to be linear with the primaries of sRGB; the file
 * appears whole or not at all. */
bool wd_exr_write(const char *path, const struct wd_exr_params *params, const struct wd_log *log);

/* One channel of a file that was read. */
struct wd_exr_plane {
    char name[256];
    enum wd_exr_type type; /* in the file */
    void *data;            /* width * height float (HALF, FLOAT) or uint32_t (UINT) */
};

struct wd_exr_image {
    uint32_t width, height;
    struct wd_exr_plane *planes; /* sorted by name */
    size_t plane_count;
    bool no_memory; /* reading failed for want of memory */
};

/* Reads the first part, scan lines of any compression but DWAA and DWAB. On failure, logged, the image holds
 * nothing but no_memory. */
bool wd_exr_read(struct wd_exr_image *image, const char *path, const struct wd_log *log);
void wd_exr_image_finish(struct wd_exr_image *image);
const struct wd_exr_plane *wd_exr_find(const struct wd_exr_image *image, const char *name);

#endif
