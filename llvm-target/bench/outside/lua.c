#include "outside.h"
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>

static const char script[] = "local function fib(n) if n < 2 then return n end return fib(n - 1) + fib(n - 2) end\n"
                             "local t, s = {}, 0\n"
                             "for i = 1, 800 do t[i] = (i * 7919) % 1009 end\n"
                             "table.sort(t)\n"
                             "local words = {}\n"
                             "for w in (('the quick brown fox jumps over the lazy dog '):rep(8)):gmatch('%a+') do "
                             "words[w] = (words[w] or 0) + 1 end\n"
                             "for _, n in pairs(words) do s = s + n end\n"
                             "local parts = {}\n"
                             "for i = 1, 60 do parts[#parts + 1] = string.format('%d:%x', i, i * i) end\n"
                             "return fib(14) + s + t[400] + #table.concat(parts, ',')\n";

void kernel_setup(void) {
  outside_begin();
}

/* An allocator that takes little time, so that the interpreter is measured and not the library's heap. */
static char memory[1 << 20];
static uint32_t used;
static void *allocate(void *unused, void *old, size_t old_size, size_t size) {
  (void)unused;
  if (size <= old_size)
    return size ? old : NULL;
  uint32_t at = (used + 7) & ~7u;
  if (at + size > sizeof memory)
    return NULL;
  used = at + (uint32_t)size;
  return old ? memcpy(memory + at, old, old_size) : memory + at;
}

struct result kernel_run(void) {
  used = 0;
  lua_State *state = lua_newstate(allocate, NULL);
  luaL_requiref(state, "_G", luaopen_base, 1);
  luaL_requiref(state, "string", luaopen_string, 1);
  luaL_requiref(state, "table", luaopen_table, 1);
  lua_settop(state, 0);
  uint32_t sum = luaL_loadstring(state, script) || lua_pcall(state, 0, 1, 0) ? 0 : (uint32_t)lua_tointeger(state, -1);
  lua_close(state);
  return (struct result){sum, 0};
}
