/* A directory for a test's own files. */
#ifndef TRAX_TEST_TEMPORARY_H
#define TRAX_TEST_TEMPORARY_H

/* Made at the first call of any of these, and removed at exit with the files in it. If it cannot be made, the program
 * ends with status 1. */
const char *test_directory(void);
/* directory/name, valid until 63 others were asked for. */
const char *test_path(const char *name);
unsigned count_files(void);

#endif
