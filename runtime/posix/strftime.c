/* Calendar time as text. */
#include <stdio.h>
#include <string.h>
#include <time.h>

static const char *const days[] = {"Sunday", "Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday"};
static const char *const months[] = {"January", "February", "March",     "April",   "May",      "June",
                                     "July",    "August",   "September", "October", "November", "December"};

static int is_leap(int year) {
  return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
}

/* The year and week of ISO 8601: weeks begin on Mondays, and the first has January 4. */
static int iso_week(const struct tm *parts, int *year) {
  int monday = (parts->tm_wday + 6) % 7; /* days since Monday */
  int week = (parts->tm_yday - monday + 10) / 7;
  *year = parts->tm_year + 1900;
  if (week < 1) {
    --*year;
    return (parts->tm_yday + 365 + is_leap(*year) - monday + 10) / 7;
  }
  int next = (parts->tm_wday + 365 + is_leap(*year) - parts->tm_yday) % 7; /* weekday of January 1 */
  if (week == 53 && next >= 1 && next <= 4) {
    ++*year;
    return 1;
  }
  return week;
}

static const char *name_of(const char *const *names, int number, int count) {
  return number >= 0 && number < count ? names[number] : "?";
}

/* Expands one conversion into text. If it abbreviates another format, *other receives that format. */
static void convert(char *text, size_t size, char letter, const struct tm *parts, const char **other) {
  int year = parts->tm_year + 1900, hour = parts->tm_hour % 12 ? parts->tm_hour % 12 : 12, iso;
#define NUMBER(FORMAT, VALUE) sniprintf(text, size, FORMAT, VALUE)
  switch (letter) {
  case 'a':
    NUMBER("%.3s", name_of(days, parts->tm_wday, 7));
    break;
  case 'A':
    NUMBER("%s", name_of(days, parts->tm_wday, 7));
    break;
  case 'b':
  case 'h':
    NUMBER("%.3s", name_of(months, parts->tm_mon, 12));
    break;
  case 'B':
    NUMBER("%s", name_of(months, parts->tm_mon, 12));
    break;
  case 'c':
    *other = "%a %b %e %H:%M:%S %Y";
    break;
  case 'C':
    NUMBER("%02d", year / 100);
    break;
  case 'd':
    NUMBER("%02d", parts->tm_mday);
    break;
  case 'D':
  case 'x':
    *other = "%m/%d/%y";
    break;
  case 'e':
    NUMBER("%2d", parts->tm_mday);
    break;
  case 'F':
    *other = "%Y-%m-%d";
    break;
  case 'g':
    iso_week(parts, &iso);
    NUMBER("%02d", iso % 100);
    break;
  case 'G':
    iso_week(parts, &iso);
    NUMBER("%d", iso);
    break;
  case 'H':
    NUMBER("%02d", parts->tm_hour);
    break;
  case 'I':
    NUMBER("%02d", hour);
    break;
  case 'j':
    NUMBER("%03d", parts->tm_yday + 1);
    break;
  case 'm':
    NUMBER("%02d", parts->tm_mon + 1);
    break;
  case 'M':
    NUMBER("%02d", parts->tm_min);
    break;
  case 'n':
    NUMBER("%s", "\n");
    break;
  case 'p':
    NUMBER("%s", parts->tm_hour < 12 ? "AM" : "PM");
    break;
  case 'r':
    *other = "%I:%M:%S %p";
    break;
  case 'R':
    *other = "%H:%M";
    break;
  case 's': {
    struct tm copy = *parts;
    NUMBER("%lld", mktime(&copy));
    break;
  }
  case 'S':
    NUMBER("%02d", parts->tm_sec);
    break;
  case 't':
    NUMBER("%s", "\t");
    break;
  case 'T':
  case 'X':
    *other = "%H:%M:%S";
    break;
  case 'u':
    NUMBER("%d", parts->tm_wday ? parts->tm_wday : 7);
    break;
  case 'U':
    NUMBER("%02d", (parts->tm_yday + 7 - parts->tm_wday) / 7);
    break;
  case 'V':
    NUMBER("%02d", iso_week(parts, &iso));
    break;
  case 'w':
    NUMBER("%d", parts->tm_wday);
    break;
  case 'W':
    NUMBER("%02d", (parts->tm_yday + 7 - (parts->tm_wday + 6) % 7) / 7);
    break;
  case 'y':
    NUMBER("%02d", year % 100);
    break;
  case 'Y':
    NUMBER("%d", year);
    break;
  case 'z':
    NUMBER("%s", "+0000");
    break;
  case 'Z':
    NUMBER("%s", "UTC");
    break;
  default:
    NUMBER("%c", letter);
  }
#undef NUMBER
}

size_t strftime(char *restrict to, size_t size, const char *restrict format, const struct tm *restrict parts) {
  size_t used = 0;
  const char *behind = NULL; /* the rest of the format after a conversion that is short for a format */
  for (;; format++) {
    if (!*format) {
      if (!behind)
        break;
      format = behind;
      behind = NULL;
      if (!*format)
        break;
    }
    char text[24];
    const char *other = NULL;
    if (*format != '%' || !format[1]) {
      text[0] = *format;
      text[1] = 0;
    } else {
      format++;
      if ((*format == 'E' || *format == 'O') && format[1])
        format++;
      convert(text, sizeof text, *format, parts, &other);
      if (other) {
        behind = format + 1;
        format = other - 1;
        continue;
      }
    }
    size_t length = strlen(text);
    if (used + length >= size)
      return 0;
    memcpy(to + used, text, length);
    used += length;
  }
  if (used >= size)
    return 0;
  to[used] = 0;
  return used;
}

char *asctime(const struct tm *parts) {
  static char text[40];
  strftime(text, sizeof text, "%a %b %e %H:%M:%S %Y\n", parts);
  return text;
}

char *ctime(const time_t *seconds) {
  return asctime(localtime(seconds));
}
