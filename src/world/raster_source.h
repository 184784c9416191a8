/* raster_source.h: an open band of a GDAL raster: where its pixels stand, and their values. */
#ifndef WD_WORLD_RASTER_SOURCE_H
#define WD_WORLD_RASTER_SOURCE_H

#include "weald/types.h"
#include "world/raster_crs.h"

/* Which values are no data. */
struct wd_missing_rule {
    double extra;       /* besides the file's own and NaN; NaN: none */
    bool heights;       /* values in metres: feet are converted; what cannot be a height on Earth
                           (undeclared -9999 and -32768, below -500, above 9000) is missing too */
    double vertical_scale; /* heights: what the caller makes metres of the values with; 0: they are */
};

struct wd_raster_source {
    char *path;
    GDALDatasetH dataset;
    GDALRasterBandH band;
    int width, height;        /* pixels */
    OGRSpatialReferenceH crs; /* of the file, else NULL */
    bool has_affine;          /* crs_of_pixel holds */
    bool has_position;        /* affine, or ground control points */
    double crs_of_pixel[6];   /* GDAL's geotransform: pixel corners to coordinates */
};

/* Opens `name` beside `base`. `key` names the setting in messages. */
bool wd_source_open(struct wd_raster_source *source, const char *base, const char *name,
                    int64_t band, const char *key, const struct wd_log *log);
void wd_source_finish(struct wd_raster_source *source);
/* False, logged, where a raster of text has words for cells, or more or fewer than it says; others are not
 * looked at. */
bool wd_source_check_text(const struct wd_raster_source *source, const struct wd_log *log);

/* From coordinates of a wanted frame to pixel coordinates of a source: pixel (i, j) covers
 * [i, i+1) x [j, j+1), j southward in most files. */
struct wd_pixel_map {
    void *transformer;        /* NULL: affine */
    double pixel_of_frame[6];
};
/* The frame is `frame` (NULL: the source's own CRS); `source_crs` may be NULL if `frame` is. */
bool wd_pixel_map_init(struct wd_pixel_map *map, struct wd_raster_source *source,
                       OGRSpatialReferenceH source_crs, OGRSpatialReferenceH frame,
                       const struct wd_log *log);
void wd_pixel_map_finish(struct wd_pixel_map *map);
/* In place; NaN where there is no answer. */
void wd_pixel_map_apply(const struct wd_pixel_map *map, int count, double *x, double *y);

/* Bounds and the size of a pixel (x, y) in the frame. */
struct wd_frame_bounds {
    double min[2], max[2];
    double pixel[2];
};
bool wd_source_bounds(const struct wd_raster_source *source, const struct wd_pixel_map *map,
                      struct wd_frame_bounds *bounds, const struct wd_log *log);

/* Pixel coordinates of a regular grid in the frame, kept exactly at every WD_MAPPING_STEP-th node
 * and at the last, bilinear between: far below a hundredth of a pixel off. */
enum { WD_MAPPING_STEP = 32 };
struct wd_mapping {
    uint32_t columns, rows;      /* nodes kept */
    uint32_t width, height;
    double *px, *py;
    double min[2], max[2];       /* of all nodes, without NaN; min > max: none */
};
/* Node (i, j) is at first + (i, j) * step. */
void wd_mapping_init(struct wd_mapping *mapping, const struct wd_pixel_map *map, uint32_t width,
                     uint32_t height, const double first[2], const double step[2]);
void wd_mapping_finish(struct wd_mapping *mapping);
void wd_mapping_at(const struct wd_mapping *mapping, uint32_t i, uint32_t j, double *px,
                   double *py);

/* Blocks of step x step pixels, the first at pixel (x, y); the source's row order. */
struct wd_source_blocks {
    int x, y, step;
    int columns, rows;
};
/* The blocks over what `mapping` touches, with two more around where there are some, aligned so
 * that the mapping's first node is a block's centre. False, without a message: no overlap. */
bool wd_source_blocks_over(const struct wd_raster_source *source, const struct wd_mapping *mapping,
                           int step, struct wd_source_blocks *blocks);

enum wd_reduction { WD_REDUCE_CENTRE, WD_REDUCE_MEAN, WD_REDUCE_MAX };
/* One value a block; NaN: no data in it. Blocks above 4 x 4 pixels are read by a subset of theirs.
 * values[columns * rows]. */
bool wd_source_read(struct wd_raster_source *source, const struct wd_source_blocks *blocks,
                    enum wd_reduction reduction, const struct wd_missing_rule *rule, float *values,
                    const struct wd_progress *progress, const struct wd_log *log);

#endif
