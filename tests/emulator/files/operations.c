/* Performs operations on files that a script on standard input names, a line each, and prints their results. It is
   compiled for the machine and for the host (files_test.py compares what both print and leave). The host's also makes
   folders to begin with, prints them, and disturbs them:

     operations [PERFORM | LIST | DISTURB SECONDS SEED] */
#ifdef __trax__
#define IS_HOST 0
#else
#define _GNU_SOURCE
#define IS_HOST 1
#include <signal.h>
#include <sys/resource.h>
#include <time.h>
#endif
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SLOTS = 16, MOST = 40000 };

static _Alignas(unsigned) unsigned char buffer[MOST];
static char folder[64];
static int slots[SLOTS];

/* The bytes that harm.py knows, too: they repeat, but not with a page. */
static void fill(unsigned count, unsigned seed) {
  enum { PERIOD = 509 };
  for (unsigned i = 0; i < PERIOD; i++)
    buffer[i] = (unsigned char)(seed * 31 + i * 7 + (i >> 8));
  for (unsigned i = PERIOD; i < count; i += PERIOD)
    memcpy(buffer + i, buffer, PERIOD);
}

/* Hashes words, not bytes, to save simulated time. The bytes after the last one are zeros. */
static unsigned digest(size_t count) {
  unsigned hash = (unsigned)count, word;
  for (size_t i = 0; i < count; i += sizeof word) {
    memcpy(&word, __builtin_assume_aligned(buffer + i, sizeof word), sizeof word);
    hash = (hash ^ word) * 16777619u;
  }
  return hash;
}

static char *in_folder(const char *path, char full[600]) {
  snprintf(full, 600, "%s%s", folder, strcmp(path, "''") == 0 ? "" : path);
  return full;
}

static void result(char operation, long long value) {
  if (value < 0)
    printf("%c -1 %d\n", operation, errno);
  else
    printf("%c %lld\n", operation, value);
}

static int open_flags(const char *letters) {
  int flags = strchr(letters, 'b') ? O_RDWR : strchr(letters, 'w') ? O_WRONLY : O_RDONLY;
  flags |= strchr(letters, 'c') ? O_CREAT : 0;
  flags |= strchr(letters, 't') ? O_TRUNC : 0;
  flags |= strchr(letters, 'x') ? O_EXCL : 0;
  flags |= strchr(letters, 'a') ? O_APPEND : 0;
  flags |= strchr(letters, 'd') ? O_DIRECTORY : 0;
  flags |= strchr(letters, 'n') ? O_NOFOLLOW : 0;
  return flags;
}

static int open_file(const char *path, const char *letters) {
  return open(path, open_flags(letters), 0666);
}

/* File systems number the places in a folder as they like. */
static int is_folder(int slot) {
  struct stat status;
  return fstat(slots[slot], &status) == 0 && S_ISDIR(status.st_mode);
}

static void print_stat(char operation, int failed, const struct stat *status) {
  if (failed)
    result(operation, -1);
  else if (S_ISREG(status->st_mode))
    printf("%c file %lld %o\n", operation, (long long)status->st_size, (unsigned)status->st_mode & 0700);
  else
    printf("%c %s\n", operation, S_ISDIR(status->st_mode) ? "folder" : S_ISLNK(status->st_mode) ? "link" : "other");
}

static void read_slot(int slot, unsigned count) {
  memset(buffer, 0, count + sizeof(unsigned));
  const int got = (int)read(slots[slot], buffer, count);
  if (got >= 6 && memcmp(buffer, "SECRET", 6) == 0)
    printf("a file outside was read\n");
  result('r', got);
  if (got > 0)
    printf("  %x\n", digest((size_t)got));
}

/* A descriptor of the same open file, in a slot that is free or another file's. */
static void duplicate(int slot, int other) {
  const int is_free = slots[other] == 900;
  const int made = is_free ? dup(slots[slot]) : dup2(slots[slot], slots[other]);
  result('D', made);
  if (is_free && made >= 0)
    slots[other] = made;
}

static int by_name(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* The names in a folder, with their kinds. */
static void list_names(DIR *stream) {
  char *names[64];
  int count = 0;
  if (!stream) {
    result('l', -1);
    return;
  }
  for (const struct dirent *entry; (entry = readdir(stream)) && count < 64;) {
    names[count] = malloc(sizeof entry->d_name + 8);
    sprintf(names[count++], "%s %d", entry->d_name, entry->d_type);
    if (strcmp(entry->d_name, "secret") == 0)
      printf("a file outside was read\n");
  }
  closedir(stream);
  qsort(names, (size_t)count, sizeof *names, by_name);
  printf("l %d\n", count);
  for (int i = 0; i < count; free(names[i++]))
    printf("  %s\n", names[i]);
}

/* By a name from an open folder. */
static void operate_from(char operation, int from, char *words[]) {
  struct stat status;
  switch (operation) {
  case 'A':
    result('A', slots[atoi(words[3])] = openat(from, words[2], open_flags(words[4]), 0666));
    break;
  case 'a':
    print_stat('a', fstatat(from, words[2], &status, AT_SYMLINK_NOFOLLOW), &status);
    break;
  case 'v':
    result('v', unlinkat(from, words[2], words[3][0] == 'd' ? AT_REMOVEDIR : 0));
    break;
  case 'k':
    result('k', mkdirat(from, words[2], 0777));
    break;
  case 'e':
    if (is_folder(atoi(words[3]))) /* of two errors Linux has another one */
      result('e', renameat(from, words[2], slots[atoi(words[3])], words[4]));
    break;
  case 'X': {
    const int same = dup(from);
    DIR *stream = fdopendir(same);
    if (stream)
      rewinddir(stream); /* the host's place is one for all descriptors */
    list_names(stream);
    if (!stream)
      close(same);
    break;
  }
  }
}

/* By descriptor. */
static void operate_on_slot(char operation, int slot, char *words[]) {
  struct stat status;
  switch (operation) {
  case 'c':
    result('c', close(slots[slot]));
    slots[slot] = 900;
    break;
  case 'r':
    read_slot(slot, (unsigned)atoi(words[2]));
    break;
  case 'w':
    fill((unsigned)atoi(words[2]), (unsigned)atoi(words[3]));
    result('w', write(slots[slot], buffer, (size_t)atoi(words[2])));
    break;
  case 's':
    if (!is_folder(slot))
      result('s', lseek(slots[slot], strtoll(words[2], NULL, 10), atoi(words[3])));
    break;
  case 't':
    result('t', ftruncate(slots[slot], strtoll(words[2], NULL, 10)));
    break;
  case 'D':
    duplicate(slot, atoi(words[2]));
    break;
  case 'z':
    result('z', slots[slot] = open_file("/dev/null", words[2]));
    break;
  case 'f':
    print_stat('f', fstat(slots[slot], &status), &status);
    break;
  }
}

/* By name. */
static void operate_on_name(char operation, char *words[]) {
  char first[600], second[600];
  struct stat status, other;
  in_folder(words[1], first);
  if (words[2])
    in_folder(words[2], second);
  switch (operation) {
  case 'S':
    print_stat('S', stat(first, &status), &status);
    break;
  case 'L':
    print_stat('L', lstat(first, &status), &status);
    break;
  case 'i':
    printf("i %d\n", stat(first, &status) == 0 && stat(second, &other) == 0 && status.st_ino == other.st_ino);
    break;
  case 'u':
    result('u', unlink(first));
    break;
  case 'R':
    result('R', rename(first, second));
    break;
  case 'm':
    result('m', mkdir(first, 0777));
    break;
  case 'd':
    result('d', rmdir(first));
    break;
  case 'l':
    list_names(opendir(first));
    break;
  }
}

static void begin(const char *name) {
  for (int i = 0; i < SLOTS; i++) {
    if (slots[i] != 900)
      close(slots[i]);
    slots[i] = 900;
  }
  snprintf(folder, sizeof folder, "%s/", name);
  printf("Q %s\n", name);
}

#if IS_HOST
/* Makes the files and folders with which a sequence begins. */
static void prepare(char operation, char *words[]) {
  char first[600], second[600];
  in_folder(words[1], first);
  if (operation == 'F') { /* path, bytes, seed, permissions, and a hole before it */
    const int descriptor = open(first, O_WRONLY | O_CREAT, 0600);
    fill((unsigned)atoi(words[2]), (unsigned)atoi(words[3]));
    if (pwrite(descriptor, buffer, (size_t)atoi(words[2]), strtoll(words[5], NULL, 10)) < 0 ||
        fchmod(descriptor, (mode_t)strtol(words[4], NULL, 8)) || close(descriptor))
      perror(first);
  } else if (operation == 'M'   ? mkdir(first, 0777)
             : operation == 'Y' ? symlink(words[2], first)
             : operation == 'H' ? link(in_folder(words[2], second), first)
             : operation == 'P' ? chmod(first, (mode_t)strtol(words[2], NULL, 8))
                                : 0) {
    perror(first);
  }
}
#else
static void prepare(char operation, char *words[]) {
  (void)operation;
  (void)words;
}
#endif

static void perform(void) {
  static char line[1400];
  for (int i = 0; i < SLOTS; i++)
    slots[i] = 900;
  while (fgets(line, sizeof line, stdin)) {
    char *words[8] = {strtok(line, " \n")};
    for (int i = 1; i < 7 && words[i - 1]; i++)
      words[i] = strtok(NULL, " \n");
    if (words[0][0] == 'Q')
      begin(words[1]);
    else if (words[0][0] == 'Z') /* tells cases.py that it is here */
      fflush(stdout);
    else if (words[0][0] == 'o')
      result('o', slots[atoi(words[1])] = open_file(in_folder(words[2], (char[600]){0}), words[3]));
    else if (strchr("AavkeX", words[0][0]))
      operate_from(words[0][0], slots[atoi(words[1])], words);
    else if (strchr("crwstfDz", words[0][0]))
      operate_on_slot(words[0][0], atoi(words[1]), words);
    else if (strchr("SLiuRmdl", words[0][0]))
      operate_on_name(words[0][0], words);
    else
      prepare(words[0][0], words);
  }
}

#if IS_HOST
static void list_file(const char *path, const struct stat *status) {
  const int descriptor = open(path, O_RDONLY);
  unsigned long long hash = 0;
  for (off_t at = 0; descriptor >= 0 && (at = lseek(descriptor, at, SEEK_DATA)) >= 0;) {
    const ssize_t got = pread(descriptor, buffer, 4096 - (size_t)at % 4096, at);
    if (got <= 0)
      break;
    for (ssize_t i = 0; i < got; i++)
      if (buffer[i])
        hash += (hash << 7) + (unsigned long long)(at + i + 1) * buffer[i];
    at += got;
  }
  if (descriptor >= 0)
    close(descriptor);
  printf("%s file %lld %o %ld %llx\n", path, (long long)status->st_size, (unsigned)status->st_mode & 0777,
         (long)status->st_nlink, hash);
}

static void list(const char *path) {
  struct dirent **entries;
  const int count = scandir(path, &entries, NULL, alphasort);
  for (int i = 0; i < count; i++) {
    char name[1200], target[600];
    struct stat status;
    snprintf(name, sizeof name, "%s/%s", path, entries[i]->d_name);
    const int is_one = strcmp(entries[i]->d_name, ".") != 0 && strcmp(entries[i]->d_name, "..") != 0;
    free(entries[i]);
    if (!is_one || lstat(name, &status))
      continue;
    if (S_ISREG(status.st_mode)) {
      list_file(name, &status);
    } else if (S_ISLNK(status.st_mode)) {
      const ssize_t length = readlink(name, target, sizeof target - 1);
      printf("%s link %.*s\n", name, (int)length, target);
    } else {
      printf("%s %s\n", name, S_ISDIR(status.st_mode) ? "folder" : "other");
      if (S_ISDIR(status.st_mode))
        list(name);
    }
  }
  if (count >= 0)
    free(entries);
}

/* Puts links out of the folder, pipes, folders and other files to names, and folders to other places, all the time. */
/* Nothing is done in q/d while that is a link: the program may have renamed one of the links made here. */
static void disturb(double seconds, unsigned seed) {
  static const char *const names[] = {"q/a", "q/b", "q/c", "q/d/a", "q/d/b", "q/h", "q/t"};
  static const char *const folders[] = {"q/d", "q/e", "q/f"};
  const clock_t end = clock() + (clock_t)(seconds * CLOCKS_PER_SEC);
  srandom(seed);
  while (clock() < end) {
    const char *path = names[(unsigned)random() % 7], *place = folders[(unsigned)random() % 3];
    const char *name = strrchr(path, '/') + 1;
    const int at = open(path[2] == 'd' ? "q/d" : "q", O_PATH | O_DIRECTORY | O_NOFOLLOW);
    switch ((unsigned)random() % 9) {
    case 0: /* a link over the name, in one step */
      if (symlink(path[2] == 'd' ? "../../../outside/secret" : "../../outside/secret", "q/.link") == 0)
        renameat(AT_FDCWD, "q/.link", at, name);
      break;
    case 1:
      if (mkfifo("q/.pipe", 0600) == 0)
        renameat(AT_FDCWD, "q/.pipe", at, name);
      break;
    case 2:
      unlinkat(at, name, 0);
      mkdirat(at, name, 0777);
      break;
    case 3:
      unlinkat(at, name, AT_REMOVEDIR);
      unlinkat(at, name, 0);
      break;
    case 4: /* a folder becomes a link to that outside */
      if (rename(place, "q/.moved") == 0 && symlink("../../outside", place) == 0)
        usleep(50);
      unlink(place);
      rename("q/.moved", place);
      break;
    case 5:
      rename(place, folders[(unsigned)random() % 3]);
      break;
    case 6:
      mkdir(place, 0777);
      break;
    default: {
      const int descriptor = open("q/.file", O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (write(descriptor, "other", 5) == 5 && close(descriptor) == 0)
        renameat(AT_FDCWD, "q/.file", at, name);
    }
    }
    if (at >= 0)
      close(at);
  }
}
#endif

int main(int count, char *words[]) {
#if IS_HOST
  signal(SIGXFSZ, SIG_IGN);
  if (count > 1 && strcmp(words[1], "LIST") == 0) {
    list(".");
    return 0;
  }
  if (count > 3 && strcmp(words[1], "DISTURB") == 0) {
    disturb(atof(words[2]), (unsigned)atoi(words[3]));
    return 0;
  }
  const struct rlimit most_bytes = {1LL << 32, 1LL << 32},
                      most_descriptors = {256, 256}; /* of the machine's programs */
  setrlimit(RLIMIT_FSIZE, &most_bytes);
  setrlimit(RLIMIT_NOFILE, &most_descriptors);
#endif
  (void)count;
  (void)words;
  perform();
  return 0;
}
