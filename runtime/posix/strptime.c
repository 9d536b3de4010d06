/* Times from text, as strftime writes them. */
#include <ctype.h>
#include <string.h>
#include <strings.h>
#include <time.h>

static const char *const days[] = {"Sunday", "Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday"};
static const char *const months[] = {"January", "February", "March",     "April",   "May",      "June",
                                     "July",    "August",   "September", "October", "November", "December"};

/* A number of at most so many digits in [least, most], less `minus`. */
static const char *number(const char *text, int digits, int least, int most, int minus, int *to) {
  int value = 0, any = 0;
  while (isspace((unsigned char)*text))
    text++;
  for (; digits > 0 && isdigit((unsigned char)*text); digits--, text++, any = 1)
    value = value * 10 + (*text - '0');
  if (!any || value < least || value > most)
    return NULL;
  *to = value - minus;
  return text;
}

static const char *name(const char *text, const char *const *names, int count, int *to) {
  for (int i = 0; i < count; i++)
    for (size_t length = strlen(names[i]); length >= 3; length = length > 3 ? 3 : 0)
      if (strncasecmp(text, names[i], length) == 0) {
        *to = i;
        return text + length;
      }
  return NULL;
}

/* "Z", or hours east of Greenwich and minutes, if any: "+01", "+0130", "-01:30". Sets the seconds. */
static const char *offset(const char *text, long *to) {
  while (isspace((unsigned char)*text))
    text++;
  const int sign = *text == '-' ? -1 : *text == '+';
  int value = 0, digits = 0;
  if (!sign && *text != 'Z')
    return NULL;
  for (text++; sign && digits < 4 && isdigit((unsigned char)*text); digits++) {
    value = value * 10 + (*text++ - '0');
    text += digits == 1 && text[0] == ':' && isdigit((unsigned char)text[1]);
  }
  value *= digits == 2 ? 100 : 1;
  if (digits % 2 || (sign && !digits) || value % 100 >= 60)
    return NULL;
  *to = sign * (value / 100 * 3600L + value % 100 * 60L);
  return text;
}

char *strptime(const char *restrict text, const char *restrict format, struct tm *restrict to) {
  enum { NONE = -1 };
  int century = NONE, year = NONE, afternoon = NONE, has_day = 0, has_year_day = 0, ignored;
  for (; text && *format; format++) {
    if (isspace((unsigned char)*format)) {
      while (isspace((unsigned char)*text))
        text++;
      continue;
    }
    if (*format != '%') {
      if (*text++ != *format)
        return NULL;
      continue;
    }
    format++;
    if (*format == 'E' || *format == 'O')
      format++;
    switch (*format) {
    case '%':
      text = *text == '%' ? text + 1 : NULL;
      break;
    case 'a':
    case 'A':
      text = name(text, days, 7, &to->tm_wday);
      break;
    case 'b':
    case 'B':
    case 'h':
      text = name(text, months, 12, &to->tm_mon);
      has_day |= text != NULL;
      break;
    case 'c':
      text = strptime(text, "%a %b %e %H:%M:%S %Y", to);
      has_day = 1;
      break;
    case 'C':
      text = number(text, 2, 0, 99, 0, &century);
      break;
    case 'd':
    case 'e':
      text = number(text, 2, 1, 31, 0, &to->tm_mday);
      has_day = 1;
      break;
    case 'x':
    case 'D':
      text = strptime(text, "%m/%d/%y", to);
      has_day = 1;
      break;
    case 'F':
      text = strptime(text, "%Y-%m-%d", to);
      has_day = 1;
      break;
    case 'g':
      text = number(text, 2, 0, 99, 0, &ignored);
      break;
    case 'G':
      text = number(text, 4, 0, 9999, 0, &ignored);
      break;
    case 'H':
    case 'k':
      text = number(text, 2, 0, 23, 0, &to->tm_hour);
      break;
    case 'I':
    case 'l':
      text = number(text, 2, 1, 12, 0, &to->tm_hour);
      afternoon = afternoon == NONE ? 0 : afternoon;
      break;
    case 'j':
      text = number(text, 3, 1, 366, 1, &to->tm_yday);
      has_year_day = 1;
      break;
    case 'm':
      text = number(text, 2, 1, 12, 1, &to->tm_mon);
      has_day = 1;
      break;
    case 'M':
      text = number(text, 2, 0, 59, 0, &to->tm_min);
      break;
    case 'n':
    case 't':
      while (isspace((unsigned char)*text))
        text++;
      break;
    case 'p':
      afternoon = strncasecmp(text, "PM", 2) == 0;
      text = afternoon || strncasecmp(text, "AM", 2) == 0 ? text + 2 : NULL;
      break;
    case 'r':
      text = strptime(text, "%I:%M:%S %p", to);
      break;
    case 'R':
      text = strptime(text, "%H:%M", to);
      break;
    case 's': {
      time_t seconds = 0;
      if (!isdigit((unsigned char)*text))
        return NULL;
      for (; isdigit((unsigned char)*text); text++)
        seconds = seconds * 10 + (*text - '0');
      gmtime_r(&seconds, to);
      break;
    }
    case 'S':
      text = number(text, 2, 0, 60, 0, &to->tm_sec);
      break;
    case 'X':
    case 'T':
      text = strptime(text, "%H:%M:%S", to);
      break;
    case 'u':
      text = number(text, 1, 1, 7, 0, &to->tm_wday);
      to->tm_wday %= 7;
      break;
    case 'w':
      text = number(text, 1, 0, 6, 0, &to->tm_wday);
      break;
    case 'U':
    case 'V':
    case 'W':
      text = number(text, 2, 0, 53, 0, &ignored);
      break;
    case 'y':
      text = number(text, 2, 0, 99, 0, &year);
      break;
    case 'Y':
      text = number(text, 4, 0, 9999, 1900, &to->tm_year);
      has_day = 1;
      year = century = NONE;
      break;
    case 'z':
      text = offset(text, &to->tm_gmtoff);
      break;
    case 'Z':
      while (isalpha((unsigned char)*text))
        text++;
      break;
    default:
      return NULL;
    }
  }
  if (!text)
    return NULL;
  if (year != NONE || century != NONE) {
    const int in_century = year == NONE ? 0 : year;
    to->tm_year = century == NONE ? in_century + (in_century < 69 ? 100 : 0) : (century - 19) * 100 + in_century;
    has_day = 1;
  }
  if (afternoon != NONE)
    to->tm_hour = to->tm_hour % 12 + 12 * afternoon;
  if (has_day && !has_year_day && to->tm_mday > 0) { /* the day of the week and of the year */
    struct tm day = {.tm_year = to->tm_year, .tm_mon = to->tm_mon, .tm_mday = to->tm_mday};
    timegm(&day);
    to->tm_wday = day.tm_wday;
    to->tm_yday = day.tm_yday;
  }
  return (char *)(unsigned long)text;
}
