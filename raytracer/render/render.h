/* Pictures of a scene, three ways: by the device program on the emulator, by the same source compiled for the host (the
   native twin), and by Embree. All take one frame: the bytes that the device program reads.

   Functions return TRAX_OK, TRAX_ERROR or TRAX_FAULT with the reason in *error, or TRAX_INTERRUPTED. */
#ifndef TRAX_RENDER_H
#define TRAX_RENDER_H

#include "layouts/layouts.h"
#include "trax/access.h"
#include "trax/emulator.h"
#include "trax/ray_kinds.h"
#include "trax/record.h"
#include "trax/render_params.h"
#include "trax/scene.h"
#include "trax/view.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* --- frame.c: what is rendered --- */

struct trax_frame_options {
  uint32_t width, height; /* pixels, 1 to TRAX_RENDER_MAX_SIDE */
  float ambient;          /* of the light: what surfaces send back that the light does not reach, 0 to 1 */
  uint32_t background;    /* a pixel */
  uint32_t samples;       /* rays from the eye through a pixel, 1 to TRAX_RENDER_MAX_SAMPLES */
  bool shadows;           /* false: the light shines through everything */
  bool smooth;            /* shading by the scene's normals, if it has them */
  bool floats;            /* linear floats as well as pixels */
  bool one_sided;         /* back faces, clockwise as a ray sees them, are not there; those of glass are */
  uint32_t paths;         /* most surfaces of a path, up to TRAX_RENDER_MAX_DEPTH; 0: no path tracing */
  uint32_t seed;          /* of the paths, and of occlusion rays */
  uint32_t occlusion;     /* rays for ambient occlusion, up to TRAX_RENDER_MAX_OCCLUSION; 0: none */
  double occlusion_reach; /* their length, as a part of the diagonal of the scene's box; 0: TRAX_DEFAULT_REACH */
  bool mark_rays;         /* the program counts each ray where it begins */
  const struct trax_environment *environment; /* light from all directions instead of the background; NULL: none */
};

struct trax_frame {
  struct trax_render_params *params; /* with what render_params.h has behind it; from malloc */
  uint32_t params_size;              /* bytes */
  const struct trax_scene *scene;
  const struct trax_rays *rays; /* the slots are these, not pixels (rays.h); NULL: they are pixels */
  struct trax_view view;        /* Embree's picture takes lights, depth and reach from these, not from the parameters */
  struct trax_frame_options options;
};

#define TRAX_DEFAULT_AMBIENT 0.12f
#define TRAX_DEFAULT_REACH 0.1
#define TRAX_DEFAULT_BACKGROUND 0xFFB8A898u /* R 0x98, G 0xA8, B 0xB8, A 0xFF */

/* Scales scene and view by a power of two if products of three coordinates would leave the range of floats. The picture
   stays the same, because nothing depends on the unit of length. *exponent is the power, 0 if nothing was done. Errors:
   no scale suffices, as for a light farther away than 2^40 times the scene's size. */
trax_status trax_normalise(struct trax_scene *scene, struct trax_view *view, int *exponent, trax_error *error);

/* Scales by 2^exponent. */
void trax_scale_scene(struct trax_scene *scene, int exponent);

/* scene and view as trax_normalise left them; scene must outlive the frame. */
trax_status trax_frame_init(struct trax_frame *frame, const struct trax_scene *scene, const struct trax_view *view,
                            const struct trax_frame_options *options, trax_error *error);
/* The order in which slots are pixels: by tiles of 2^log2_side by as many pixels, TRAX_TILE_LOG2_SIDE unless the
   picture is smaller; 0: row by row. */
void trax_frame_set_tiles(struct trax_render_params *params, uint32_t log2_side);
void trax_frame_release(struct trax_frame *frame);
/* The size of the device program's buffer `image`. */
uint32_t trax_frame_image_bytes(const struct trax_frame *frame);

/* features.c: the features that the picture needs, a bit each. */
uint32_t trax_features_of(const struct trax_frame_options *options, const struct trax_view *view,
                          const struct trax_scene *scene);
/* The feature's name in reports. */
const char *trax_feature_name(enum trax_feature feature);
/* The sections of the scene that are read for these features: 1 << enum trax_scene_section_kind each. */
uint32_t trax_feature_sections(uint32_t features);

/* --- device_scene.c: the scene in the device's memory --- */

struct trax_device_scene {
  unsigned char *bytes; /* from malloc */
  uint32_t size;
};

/* Makes a scene of the sections that the frame's features need. */
trax_status trax_device_scene_init(struct trax_device_scene *scene, const struct trax_frame *frame, trax_error *error);
void trax_device_scene_release(struct trax_device_scene *scene);
/* Replaces the references of a scene at the device's `address`, below 2^31, by addresses; those of leaves are negated.
 */
void trax_scene_relocate(void *bytes, uint32_t address);

/* --- specialise.c: the program for the TPs --- */

#define TRAX_PATH_SIZE 4096
#define TRAX_MAX_QUEUES TRAX_MAX_SLOT_QUEUES

struct trax_program {
  char path[TRAX_PATH_SIZE];
  bool specialised; /* its scene has the needed sections only, and addresses as references */
};

struct trax_specialise_options {
  const char *root;   /* where trax is installed: bin, lib/trax */
  const char *source; /* the folder of the program's source, perhaps with flags.txt; NULL: the installation's */
  const char *cache;  /* where compiled programs are kept; NULL: the user's (trax_program_cache) */
  const volatile int *interrupt; /* polled; may be NULL */
  uint32_t icache_bytes;         /* a larger program is compiled for less code; 0: as many as the paper's 4096 */
  unsigned queues;               /* of pixels (device/slots.h); more than TRAX_MAX_QUEUES are as many; 0: 1 */
  bool record;                   /* it records (trax/record.h); its stack is in global memory: times mean nothing */
};

/* Compiles the device program for one picture, or finds it in the cache. If that fails, returns TRAX_OK, gives the
   reason in note and leaves *program as it was. note also reports a damaged cached program that was compiled again.
   TRAX_ERROR: the cache that the user named cannot be written, or the general program does not serve, because it cannot
   record. */
trax_status trax_program_specialise(struct trax_program *program, const struct trax_frame *frame,
                                    const struct trax_specialise_options *options, char note[256], trax_error *error);

/* Whether the file of this name is a source. */
bool trax_is_source_name(const char *name);

/* $XDG_CACHE_HOME/trax/programs, or .cache/trax/programs in the home directory; false if there is neither. */
bool trax_program_cache(char path[TRAX_PATH_SIZE]);

struct trax_program_size {
  uint32_t code_bytes;
  uint32_t stack_bytes; /* the frames along the deepest path of calls */
};
trax_status trax_program_measure(struct trax_program_size *size, const char *path, trax_error *error);

/* --- pictures --- */

struct trax_picture {
  uint32_t width, height;
  uint32_t *pixels;           /* row by row from the top left; R, G, B, A in the bytes from the lowest; from malloc */
  float *radiance;            /* R, G, B for each pixel, linear, not bounded by 1; from malloc; NULL: of bytes only */
  struct trax_layers *layers; /* of each pixel (layers.h); from malloc; NULL: none */
};

trax_status trax_picture_init(struct trax_picture *picture, uint32_t width, uint32_t height, trax_error *error);
void trax_picture_release(struct trax_picture *picture);
/* Makes a picture of the device program's buffer `image`. */
trax_status trax_picture_take(struct trax_picture *picture, const struct trax_frame *frame, const void *image,
                              trax_error *error);

/* Writes linear floats for .pfm and .exr, else a PNG of 8-bit RGB with the gamma of the palette
   (2); aside and renamed. */
trax_status trax_picture_write(const struct trax_picture *picture, const char *path, trax_error *error);
bool trax_picture_is_float(const char *path);
/* A PNG, brought to 8-bit RGBA without touching its gamma, or a PFM, EXR or HDR (radiance.h), by its first bytes. */
trax_status trax_picture_read(struct trax_picture *picture, const char *path, trax_error *error);
/* Reads the same from memory. */
trax_status trax_picture_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                                trax_error *error);

struct trax_difference {
  unsigned largest; /* of all channels' differences, 0 to 255 */
  uint64_t pixels;  /* compared */
  uint64_t unequal; /* pixels that differ at all, if only in a bit of their floats */
  uint64_t beyond;  /* pixels with a channel that differs by more than `within` */
  uint32_t x, y;    /* the first pixel with the largest difference */
  double rmse;      /* root of the mean square of the differences of R, G and B, 0 to 255 */
  /* if both pictures have linear floats: */
  bool floats;
  double radiance_rmse;   /* of the channels that are finite in both */
  double root_rmse;       /* of the same channels' roots, in parts of 255 */
  uint64_t not_finite;    /* the other channels */
  uint64_t floats_beyond; /* pixels with floats that differ by more than `within` parts in 255 of their root, or of 1 if
                             that is darker */
  double most;            /* the largest of these differences, in the same parts */
};

/* Compares two pictures of one size, alpha included. */
void trax_picture_compare(struct trax_difference *difference, const struct trax_picture *a,
                          const struct trax_picture *b, unsigned within);
/* The mean of the light, linear: of the floats if there are any, else of what the pixels show, 0 to 1. */
double trax_picture_light(const struct trax_picture *picture);
double trax_difference_percent(const struct trax_difference *difference); /* of pixels not beyond */
/* The per cent of floats not beyond; without floats, of pixels. */
double trax_difference_floats_percent(const struct trax_difference *difference);

/* --- renderers --- */

struct trax_render_run {
  void (*progress)(void *context, uint64_t done, uint64_t total); /* about ten times a second; may be NULL */
  void *progress_context;
  const volatile int *interrupt;       /* polled; may be NULL */
  uint64_t rays;                       /* out: rays traced; 0 with accesses, which know of them slot by slot */
  uint64_t kinds[TRAX_RAY_KIND_COUNT]; /* out, of the twin: the same by kind */
  bool layers;                         /* the picture gets layers (layers.h) */
  bool exactly; /* of Embree: hits without error (exact.h), of the rays that the device program has */
  struct trax_access_log *accesses; /* records the reads of the twin, which then has one thread; or NULL */
};

/* twin.c: the device program on `threads` host threads (0: as many as the host has). One run at a time in a process:
   the program's globals are the process's. */
trax_status trax_render_twin(struct trax_picture *picture, const struct trax_frame *frame, unsigned threads,
                             struct trax_render_run *run, trax_error *error);

/* embree.c: Embree 3 in robust mode finds the same hits among the same triangles; shading in binary64. */
trax_status trax_render_embree(struct trax_picture *picture, const struct trax_frame *frame,
                               struct trax_render_run *run, trax_error *error);

#define TRAX_NO_TRIANGLE UINT32_MAX

/* --- cost.c: what each pixel cost its thread, from the item before to this one --- */

struct trax_item_cost;

struct trax_costs {
  const char *name; /* what is counted: cycles, instructions, or a cause of trax-sim --help-stats */
  unsigned what;
  uint32_t width, height;
  uint64_t *values;   /* of the pixels, row by row from the top left */
  uint64_t elsewhere; /* of no pixel: before the first and behind the last one of a thread */
};

struct trax_cost_summary {
  uint64_t least, median, most, sum; /* of the pixels */
  uint64_t white;                    /* one in a hundred costs more; what the picture shows white */
};

/* Finds the quantity of a name; an error if there is none. */
trax_status trax_cost_find(const char *name, unsigned *what, trax_error *error);
trax_status trax_costs_init(struct trax_costs *costs, uint32_t width, uint32_t height, const char *name,
                            trax_error *error);
void trax_costs_release(struct trax_costs *costs);
/* For trax_explain_items; context is a trax_costs. */
void trax_costs_add(void *context, const struct trax_item_cost *cost, bool last);
trax_status trax_costs_summarise(const struct trax_costs *costs, struct trax_cost_summary *summary, trax_error *error);
/* Numbers: PFM if the path ends so, else CSV (x, y, value). */
trax_status trax_costs_write(const struct trax_costs *costs, const char *path, trax_error *error);
/* False colours, as a PNG. */
trax_status trax_costs_write_picture(const struct trax_costs *costs, const struct trax_cost_summary *summary,
                                     const char *path, trax_error *error);
void trax_costs_print(const struct trax_costs *costs, const struct trax_cost_summary *summary, FILE *out);

/* --- visits.c: how many nodes and triangles the rays of each pixel visit --- */

/* A log that counts; nodes and triangles are set back by its functions `slot` or `ray`. */
struct trax_visit_counter {
  struct trax_access_log log; /* first: its functions get its address */
  trax_access accesses[4096];
  uint32_t nodes, triangles;
};

void trax_visit_counter_init(struct trax_visit_counter *counter);
/* Counts the accesses since the last call. */
void trax_visit_count(struct trax_access_log *log);

struct trax_explore_ray;

struct trax_visits {
  uint32_t *nodes, *triangles; /* of the pixels, row by row; NULL: not known */
  /* The rays of the pixels that are wanted, by pixel. */
  struct trax_explore_ray *rays;
  size_t ray_count, ray_capacity;
  bool (*wants_rays)(const void *context, uint32_t pixel); /* NULL: none are */
  const void *context;
};

/* The twin's, if its picture is this one; otherwise it is another program's, and they are not known. */
trax_status trax_visits_count(struct trax_visits *visits, const struct trax_picture *picture,
                              const struct trax_frame *frame, struct trax_render_run *run, trax_error *error);
void trax_visits_release(struct trax_visits *visits);

/* --- simulated.c: the program on a machine made by the caller, which keeps it for its statistics --- */

struct trax_explain_options;

struct trax_simulated_options {
  trax_run_options run;
  const struct trax_explain_options *explain; /* NULL: nothing is explained */
  struct trax_costs *costs;                   /* to fill; NULL: not wanted */
  const char *title;                          /* of the page that explains the run; NULL: the program's name */
  bool layers;                                /* the program records (trax/record.h); the picture gets layers */
  bool is_twin;                               /* the program visits the nodes and triangles that the twin does */
};

/* Whether the loaded program has the symbol. */
bool trax_program_has(const trax_machine *machine, const char *symbol);
/* Loads the program and binds what it reads. */
trax_status trax_simulated_load(trax_machine *machine, const struct trax_frame *frame,
                                const struct trax_program *program, trax_error *error);
/* Runs the loaded program. With run.slots there is no picture, since most of it is left out. */
trax_status trax_simulated_run(struct trax_picture *picture, const struct trax_frame *frame, trax_machine *machine,
                               const struct trax_simulated_options *options, trax_error *error);

#endif
