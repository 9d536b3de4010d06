/* Pictures of linear floats in files: PFM (Debevec's portable float map) and OpenEXR, from and to memory. */
#ifndef TRAX_RENDER_RADIANCE_H
#define TRAX_RENDER_RADIANCE_H

#include "render.h"

/* The bytes of a file, from malloc. */
struct trax_bytes {
  uint8_t *data;
  size_t size;
};

/* picture->radiance, as a PFM or as an EXR, packed by ZIP, which also has the picture's layers if there are any. name
 * is for messages. */
trax_status trax_pfm_encode(struct trax_bytes *bytes, const struct trax_picture *picture, const char *name,
                            trax_error *error);
trax_status trax_exr_encode(struct trax_bytes *bytes, const struct trax_picture *picture, const char *name,
                            trax_error *error);

bool trax_is_pfm(const uint8_t *bytes, size_t size);
bool trax_is_exr(const uint8_t *bytes, size_t size);
bool trax_is_hdr(const uint8_t *bytes, size_t size);

/* Fills the size, the radiance and, of an EXR with all of them, the layers of *picture, which is to be released
   whatever is returned. A PFM may be of one channel and of either byte order; an EXR must have a single part of scan
   lines with channels R, G and B, plain or packed by RLE or ZIP. */
trax_status trax_pfm_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error);
trax_status trax_exr_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error);
/* hdr.c: Radiance's format, rows from the top down, of RGB. */
trax_status trax_hdr_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error);

/* Room for floats, after checks of the size. */
trax_status trax_radiance_allocate(struct trax_picture *picture, uint64_t width, uint64_t height, const char *name,
                                   trax_error *error);

#endif
