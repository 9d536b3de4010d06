/* trax-render's emulated machine: which program it runs, on what chip, and what is told about the run. */
#ifndef TRAX_RENDER_EMULATED_H
#define TRAX_RENDER_EMULATED_H

#include "live.h"
#include "trax/progress.h"

#include <stdbool.h>

/* Where this program is installed: the folder above its own. */
bool installation(char root[TRAX_PATH_SIZE]);

/* The chip that the options ask for, with memory for the frame, unless that is NULL, and more_bytes besides. */
trax_status emulated_config(trax_config *config, const struct options *options, const struct trax_frame *frame,
                            uint64_t more_bytes, trax_error *error);

/* The lines of its data cache, as trax_build_options.cache_lines takes them. */
trax_status emulated_cache_lines(unsigned *lines, const struct options *options, trax_error *error);

/* What the installation has, next to this program: ../FOLDER/NAME with its suffix. False if it cannot be read. */
bool installed_file(char path[TRAX_PATH_SIZE], const char *folder, const char *name, const char *suffix);

/* The picture, and what the options want to know of the run; view is the frame's; live may be NULL. */
trax_status emulate(struct trax_picture *picture, const struct options *options, const struct trax_frame *frame,
                    const struct trax_view *view, trax_progress_line *progress, struct live *live,
                    const volatile int *interrupt, trax_error *error);

#endif
