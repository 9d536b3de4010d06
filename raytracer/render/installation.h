/* The files that are installed with this program. */
#ifndef TRAX_RENDER_INSTALLATION_H
#define TRAX_RENDER_INSTALLATION_H

#include "render.h"

/* The folder above this program's own. False if it is not known. */
bool installation(char root[TRAX_PATH_SIZE]);

/* FOLDER/NAME with its suffix below that folder. False if it cannot be read. */
bool installed_file(char path[TRAX_PATH_SIZE], const char *folder, const char *name, const char *suffix);

#endif
