// The members of std::string that libc++'s headers expect to find compiled.
#include <string>

template class std::basic_string<char>;
