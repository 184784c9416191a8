/* blocks.h: pictures in 16 bytes for each 4 x 4 texels: Vulkan's BC3 (S3TC: Iourcha, Nayak, Hong
 * 1999), colours on a line between two of 5:6:5 bits, opacity among eight steps. */
#ifndef WD_BAKE_BLOCKS_H
#define WD_BAKE_BLOCKS_H

#include <stddef.h>
#include <stdint.h>

size_t wd_blocks_bytes(uint32_t width, uint32_t height);
size_t wd_alpha_blocks_bytes(uint32_t width, uint32_t height);

/* Packs RGBA8; texels without alpha count little. The same texels give the same bytes anywhere. */
void wd_blocks_pack(uint8_t *blocks, const uint8_t *rgba, uint32_t width, uint32_t height);

/* Alone what BC3 says of opacity: Vulkan's BC4, 8 bytes a block. */
void wd_alpha_blocks_pack(uint8_t *blocks, const uint8_t *rgba, uint32_t width, uint32_t height);

#endif
