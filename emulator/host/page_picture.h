/* The picture on the page of --explore: the buffer of the manifest's picture, or of a --dump as a picture. */
#ifndef TRAX_HOST_SHOWN_H
#define TRAX_HOST_SHOWN_H

#include "host/options.h"

struct trax_shown {
  const char *symbol; /* NULL: no picture is known */
  uint32_t width, height;
  bool is_float;    /* three linear floats a pixel; else R, G, B, A in bytes */
  uint32_t *pixels; /* from trax_shown_give */
};

/* To be called after loading: sets the buffer of the items' places, unless the options name it. Error: the manifest's
   picture does not fit in its buffer. */
trax_status trax_shown_find(struct trax_shown *shown, struct trax_explain_options *explain,
                            const struct trax_options *options, trax_machine *machine, trax_error *error);
/* Gives what the run has left in the buffer to the explanation, until whose end the pixels must stay. */
trax_status trax_shown_give(struct trax_shown *shown, trax_machine *machine, struct trax_explain *explain,
                            trax_error *error);
void trax_shown_release(struct trax_shown *shown);

#endif
