// The compiled members of std::string that libc++'s headers expect.
#include <string>

template class std::basic_string<char>;
