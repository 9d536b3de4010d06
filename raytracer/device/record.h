/* A program compiled with TRAX_RECORD, and the twin if its buffer `record` is bound, also record what their rays hit
   (trax/record.h). Other programs contain none of this. */
#ifndef TRAX_DEVICE_RECORD_H
#define TRAX_DEVICE_RECORD_H

#if defined TRAX_RECORD || defined TRAX_TWIN

#include "camera.h"
#include "run.h"
#include "trax/record.h"
#include "triangle.h"

extern struct trax_buffer record;
static _Thread_local struct trax_pixel_record record_channels; /* of the thread's last pixel_of */

#ifdef TRAX_TWIN
#define RECORDS (record.data != NULL)
#else
#define RECORDS 1
#endif

static inline uint32_t record_index(const struct trax_render_params *run, struct pixel pixel) {
  return pixel_y(pixel) * run->width + pixel_x(pixel);
}

static inline struct trax_sample_record *record_sample(const struct trax_render_params *run, struct pixel pixel,
                                                       uint32_t sample) {
  struct trax_pixel_record *pixels = record.data;
  struct trax_sample_record *samples = (struct trax_sample_record *)(pixels + run->width * run->height);
  return &samples[record_index(run, pixel) * run->samples + sample];
}

static inline void record_hit(const struct trax_render_params *run, struct pixel pixel, uint32_t sample,
                              const struct hit *hit) {
  if (!RECORDS)
    return;
  record_sample(run, pixel, sample)->triangle =
      hit->triangle ? (uint32_t)(hit->triangle - (const char *)scene.data) : 0;
#if TRAX_INSTANCES
  record_sample(run, pixel, sample)->instance =
      hit->triangle && hit->instance ? (uint32_t)(hit->instance - (const char *)scene.data) : 0;
#endif
  if (!hit->triangle) /* pixel_of is not called for a single sample */
    for (int channel = 0; channel < 3; channel++)
      record_channels.channel[channel] = (float)(int32_t)(run->background >> 8 * channel & 255);
}

static inline void record_shadow(const struct trax_render_params *run, struct pixel pixel, uint32_t sample,
                                 bool blocked) {
  if (RECORDS)
    record_sample(run, pixel, sample)->shadow = blocked ? TRAX_SHADOW_BLOCKED : TRAX_SHADOW_LIT;
}

static inline void record_pixel(const struct trax_render_params *run, struct pixel pixel) {
  if (RECORDS)
    ((struct trax_pixel_record *)record.data)[record_index(run, pixel)] = record_channels;
}

#define RECORD_HIT(run, pixel, sample, hit) record_hit(run, pixel, sample, hit)
/* Records the first surface of a path that is no hole. */
#define RECORD_SEEN(run, path, shadow, hit)                                                                            \
  ((shadow) || (path)->depth ? (void)0 : record_hit(run, (struct pixel){(path)->pixel}, (path)->sample, hit))
#define RECORD_SHADOW(run, pixel, sample, blocked) record_shadow(run, pixel, sample, blocked)
#define RECORD_CHANNELS(red, green, blue) (record_channels = (struct trax_pixel_record){{red, green, blue}})
#define RECORD_PIXEL(run, pixel) record_pixel(run, pixel)

#else
#define RECORD_HIT(run, pixel, sample, hit) ((void)0)
#define RECORD_SEEN(run, path, shadow, hit) ((void)0)
#define RECORD_SHADOW(run, pixel, sample, blocked) ((void)0)
#define RECORD_CHANNELS(red, green, blue) ((void)0)
#define RECORD_PIXEL(run, pixel) ((void)0)
#endif

#endif
