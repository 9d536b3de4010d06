/* Paths from an open folder. */
#ifndef TRAX_RUNTIME_FOLDERS_H
#define TRAX_RUNTIME_FOLDERS_H

/* The path below the folder, or "" for the folder itself; from malloc. NULL: errno says why. */
char *__trax_folder_path(int folder, const char *path);

#endif
