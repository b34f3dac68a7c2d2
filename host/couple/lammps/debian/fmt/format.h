/* format.h - stands in for a header that Debian 12's liblammps-dev includes and does not have: names that LAMMPS' own
 * headers mention, none of which the fix uses. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_FMT_FORMAT_H
#define FIBRAD_FMT_FORMAT_H

namespace fmt {
struct string_view;
struct format_args;
template <typename... Args, typename S>
format_args make_args_checked(const S &, const Args &...);
} // namespace fmt

#endif
