/* Folders below those that the user allowed. The names are read at once, in the order of their bytes. */
#ifndef TRAX_DIRENT_H
#define TRAX_DIRENT_H

#include <sys/types.h>

#define DT_UNKNOWN 0
#define DT_FIFO 1
#define DT_CHR 2
#define DT_DIR 4
#define DT_BLK 6
#define DT_REG 8
#define DT_LNK 10
#define DT_SOCK 12
#define IFTODT(mode) (((mode) & 0170000) >> 12)
#define DTTOIF(type) ((type) << 12)

struct dirent {
  ino_t d_ino;
  unsigned short d_reclen;
  unsigned char d_type;
  char d_name[256];
};
typedef struct trax_folder DIR;

#ifdef __cplusplus
extern "C" {
#endif

DIR *opendir(const char *path);
struct dirent *readdir(DIR *folder);
int closedir(DIR *folder);
void rewinddir(DIR *folder);
long telldir(DIR *folder);
void seekdir(DIR *folder, long place);
int alphasort(const struct dirent **a, const struct dirent **b);
int scandir(const char *path, struct dirent ***entries, int (*choose)(const struct dirent *),
            int (*compare)(const struct dirent **, const struct dirent **));
DIR *fdopendir(int descriptor);
int dirfd(DIR *folder);

#ifdef __cplusplus
}
#endif

#endif
