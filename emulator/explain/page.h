/* The page of --explore: explain/page/ has its text, style and script; the readers write its data as members of one
   JSON object. A table that is also a file of its own is a member of the same text. */
#ifndef TRAX_EXPLAIN_PAGE_H
#define TRAX_EXPLAIN_PAGE_H

#include "explain/span.h"

/* Writes `"name": text`, followed by a comma: put() writes the text. */
trax_status trax_page_text(FILE *out, const char *name, trax_status (*put)(void *self, FILE *out, trax_error *error),
                           void *self, trax_error *error);
/* Writes a text as JSON. Bytes that are not UTF-8 stay as they are. */
void trax_page_quote(FILE *out, const char *text, size_t size);

/* Writes a number in decimal: much faster than fprintf, for the longest tables. */
void trax_page_decimal(FILE *out, uint64_t value);
/* Writes a number as LEB128. */
void trax_page_number(FILE *out, uint64_t value);

/* The text of the page before its data and after them, which the build made (page/embed.cmake). */
extern const char *const trax_page_begin, *const trax_page_end;

/* --- sources.c: members with the sources of the lines among these names, and with the names of those left out --- */
trax_status trax_sources_put(struct trax_explain *explain, const uint32_t *names, uint32_t count, FILE *out,
                             trax_error *error);

/* --- pixels.c: the cost of each item, by its place --- */
struct trax_pixels;
struct trax_pixels *trax_pixels_create(size_t places); /* NULL: out of memory */
void trax_pixels_destroy(struct trax_pixels *pixels);  /* which may be NULL */
void trax_pixels_add(struct trax_pixels *pixels, const struct trax_item_cost *cost, bool last);
/* Writes a member that describes columns of numbers, and the columns, each number as LEB128. Without a picture it
   writes nothing. */
trax_status trax_pixels_put(struct trax_explain *explain, FILE *members, FILE *columns, trax_error *error);

/* --- pixel_rays.c: the rays of each pixel --- */
struct trax_pixel_rays;
struct trax_pixel_rays *trax_pixel_rays_create(void);       /* NULL: out of memory */
void trax_pixel_rays_destroy(struct trax_pixel_rays *rays); /* which may be NULL */
/* The next ray of a pixel, and what its thread took for it. False: out of memory. */
bool trax_pixel_rays_add(struct trax_pixel_rays *rays, uint32_t place, unsigned kind, uint64_t cycles,
                         uint64_t instructions);
/* False: those of pixels without a story are lost. */
bool trax_pixel_rays_all(const struct trax_pixel_rays *rays);
/* Writes a member, and the numbers of rays by pixel and columns of all rays, each number as LEB128. */
trax_status trax_pixel_rays_put(struct trax_explain *explain, size_t places, FILE *members, FILE *columns,
                                trax_error *error);

#endif
