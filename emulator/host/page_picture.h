/* The picture on the page of --explore: the buffer of the manifest's picture, or of a --dump as a picture. */
#ifndef TRAX_HOST_PAGE_PICTURE_H
#define TRAX_HOST_PAGE_PICTURE_H

#include "host/options.h"

struct trax_page_picture {
  const char *symbol; /* NULL: no picture is known */
  uint32_t width, height;
  bool is_float;    /* three linear floats a pixel; else R, G, B, A in bytes */
  uint32_t *pixels; /* from trax_page_picture_give */
};

/* To be called after loading: sets the buffer of the items' places, unless the options name it. Error: the manifest's
   picture does not fit in its buffer. */
trax_status trax_page_picture_find(struct trax_page_picture *picture, struct trax_explain_options *explain,
                                   const struct trax_options *options, trax_machine *machine, trax_error *error);
/* Gives the buffer's contents after the run to the explanation. The pixels must stay until its end. */
trax_status trax_page_picture_give(struct trax_page_picture *picture, trax_machine *machine,
                                   struct trax_explain *explain, trax_error *error);
void trax_page_picture_release(struct trax_page_picture *picture);

#endif
