#define _POSIX_C_SOURCE 200809L /* fork */
#include "minimise.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { SECONDS = 60, CASE_SECONDS = 20 };

static bool still_differs(const struct random_case *c) {
  fflush(NULL);
  const pid_t pid = fork();
  if (pid == 0) {
    alarm(CASE_SECONDS);
    if (!freopen("/dev/null", "w", stderr)) /* the reason is known already */
      _exit(0);
    _exit(compare_case(c).difference.text[0] != 0);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return status != 0;
}

/* Makes the candidate the case if it differs too. */
static bool accept(struct random_case *c, const struct random_case *candidate) {
  if (trax_config_validate(&candidate->config, NULL) || memcmp(c, candidate, sizeof *c) == 0 ||
      !still_differs(candidate))
    return false;
  *c = *candidate;
  return true;
}

static bool reduce_threads(struct random_case *c) {
  bool smaller = false;
  uint32_t *const of[] = {&c->config.chip.tms, &c->config.chip.tps_per_tm};
  for (unsigned i = 0; i < 2; i++)
    for (uint32_t by = *of[i] / 2; by; by /= 2)
      while (*of[i] > by) {
        struct random_case candidate = *c;
        *(i ? &candidate.config.chip.tps_per_tm : &candidate.config.chip.tms) -= by;
        if (!accept(c, &candidate))
          break;
        smaller = true;
      }
  return smaller;
}

static size_t member_size(const struct trax_config_key *key) {
  return key->kind == TRAX_KIND_FLAG ? sizeof(bool) : key->kind == TRAX_KIND_REAL ? sizeof(double) : sizeof(uint32_t);
}

static bool reduce_keys(struct random_case *c) {
  static const struct trax_config initial = TRAX_CONFIG_DEFAULT;
  bool smaller = false;
  for (size_t i = 0; i < trax_config_key_count; i++) {
    const struct trax_config_key *key = &trax_config_keys[i];
    if (strncmp(key->name, "chip.t", 6) == 0 || strcmp(key->name, "memory.size_mib") == 0)
      continue;
    struct random_case candidate = *c;
    memcpy((char *)&candidate.config + key->offset, (const char *)&initial + key->offset, member_size(key));
    smaller |= accept(c, &candidate);
  }
  return smaller;
}

static bool is_relative(trax_op op) {
  return trax_op_table[op].flags & TRAX_IS_BRANCH && op != TRAX_OP_JALR;
}

size_t without_words(const uint32_t *words, size_t count, size_t begin, size_t end, uint32_t *result) {
  size_t left = 0;
  for (size_t i = 0; i < count; i++) {
    if (i >= begin && i < end)
      continue;
    trax_inst inst = trax_decode(words[i]);
    const int64_t target = (int64_t)i + inst.imm / 4;
    if (is_relative(inst.op) && target >= 0 && target <= (int64_t)count) {
      const int64_t gone_before_target = target <= (int64_t)begin ? 0
                                         : target >= (int64_t)end ? (int64_t)(end - begin)
                                                                  : target - (int64_t)begin;
      const int64_t gone_before = i < begin ? 0 : (int64_t)(end - begin);
      inst.imm = (int32_t)(4 * (target - gone_before_target - ((int64_t)i - gone_before)));
      result[left++] = trax_encode(inst);
    } else
      result[left++] = words[i];
  }
  return left;
}

static struct random_case without(const struct random_case *c, size_t begin, size_t end) {
  struct random_case result = *c;
  memset(result.words, 0, sizeof result.words);
  result.count = without_words(c->words, c->count, begin, end, result.words);
  return result;
}

static bool reduce_words(struct random_case *c, time_t end) {
  bool smaller = false;
  for (size_t size = c->count / 2; size; size /= 2)
    for (size_t i = 0; i + size <= c->count && c->count > size && time(NULL) < end;) {
      const struct random_case candidate = without(c, i, i + size);
      if (accept(c, &candidate))
        smaller = true;
      else
        i += size;
    }
  return smaller;
}

void minimise(struct random_case *c) {
  const time_t end = time(NULL) + SECONDS;
  bool smaller = true;
  while (smaller && time(NULL) < end) {
    smaller = reduce_threads(c);
    smaller |= reduce_words(c, end);
    smaller |= reduce_keys(c);
  }
}

void print_case(const struct random_case *c, FILE *out) {
  static const struct trax_config initial = TRAX_CONFIG_DEFAULT;
  fprintf(out, "  --max-cycles %llu%s", (unsigned long long)c->max_cycles,
          c->functional_mode ? ", against the functional mode" : "");
  for (size_t i = 0; i < trax_config_key_count; i++) {
    const struct trax_config_key *key = &trax_config_keys[i];
    const double value = trax_config_value(&c->config, key);
    char word[TRAX_CONFIG_WORD];
    if (value == trax_config_value(&initial, key))
      continue;
    if (key->kind == TRAX_KIND_FLAG)
      fprintf(out, " --set %s=%s", key->name, value != 0 ? "true" : "false");
    else if (trax_config_has_words(key))
      fprintf(out, " --set %s=%s", key->name, trax_config_value_word(key, value, word));
    else
      fprintf(out, " --set %s=%.12g", key->name, value);
  }
  fprintf(out, "\n");
  for (size_t i = 0; i < c->count; i++) {
    char text[128];
    const uint32_t pc = TEXT + 4 * (uint32_t)i;
    trax_disassemble(c->words[i], pc, text, sizeof text);
    fprintf(out, "  0x%04x  %08x  %s\n", pc, c->words[i], text);
  }
}
