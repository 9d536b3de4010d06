/* trax-render's command line. */
#ifndef TRAX_RENDER_OPTIONS_H
#define TRAX_RENDER_OPTIONS_H

#include "rays.h"
#include "render.h"
#include "trax/explain.h"
#include "trax/options.h"

/* The first two simulate the machine, to the same cycle. */
enum engine { ENGINE_FAST, ENGINE_REFERENCE, ENGINE_NATIVE, ENGINE_EMBREE, ENGINE_EXACT };

struct setting {
  const char *key;
  const char *value;
};

/* Values that replace the view's. */
struct camera_options {
  struct point {
    float at[3];
    bool given;
  } eye, look_at, up;
  float fov;      /* degrees; 0: the view's */
  float orbit[2]; /* angle, elevation: degrees */
  float lights[TRAX_VIEW_MAX_LIGHTS][3];
  uint32_t light_count; /* 0: the view's */
};

enum { MOST_PIXELS = 16 };

struct options {
  const char **meshes; /* into argv */
  size_t mesh_count;
  const char *output;
  const char *config;
  unsigned queues;         /* of pixels; 0: one for each TM */
  bool choose_queues;      /* --queues was given */
  const char *environment; /* NULL: none */
  float environment_strength;
  double environment_turn; /* degrees */
  const char *view;        /* NULL: framed automatically */
  struct camera_options camera;
  unsigned frames;        /* of a sequence; 0: none */
  bool sequence;          /* --at has two moments */
  bool no_refit;          /* of a sequence's trees */
  const char *write_view; /* NULL: not wanted */
  const char *stats, *ray_cycles, *keep, *program;
  const char *ray_trace;          /* every ray; NULL: not wanted */
  const char *rays, *ray_results; /* files of rays; NULL: pixels are rendered; not wanted */
  enum trax_ray_order ray_order;
  const char *hits;   /* figures as JSON; NULL: not wanted */
  const char *source; /* of the specialised program; NULL: the installation's */
  const char *cache;  /* of specialised programs; NULL: the user's */
  const char *cost;   /* what --cost-picture and --cost-values show */
  const char *cost_picture, *cost_values;
  struct trax_explain_options explain;
  struct pixels {
    uint32_t at[MOST_PIXELS][2]; /* x, y */
    unsigned count;
  } pixels;                 /* whose stories are printed */
  struct setting *settings; /* keys are copies */
  size_t setting_count;
  struct trax_import_options import; /* materials and textures */
  struct trax_build_options build;   /* normals */
  const char *nodes;                 /* of the tree; NULL: auto */
  const char *splits;                /* NULL: auto */
  struct trax_frame_options frame;
  enum engine engine;
  unsigned threads;            /* of the fast engine and the native twin; 0: as many as the host has */
  bool sampled;                /* most of the picture is not simulated */
  trax_slot_sampling sampling; /* fraction or error, and seed */
  bool layers;                 /* of the picture (layers.h) */
  bool compare, quiet, no_specialise;
  bool prepare; /* keep is written, nothing is rendered */
};

extern const trax_command render_command;

trax_parsed options_parse(struct options *options, int argc, char **argv, trax_error *error);
/* Whether any option needs the picture, or the run. */
bool options_rendered(const struct options *options);
/* Checks that the options can be combined. */
trax_status options_check(const struct options *options, trax_error *error);
void options_release(struct options *options);

#endif
