/* settings.h - what the fix of LAMMPS and the driver of LIGGGHTS read alike, C++: numbers within bounds, the
 * options of rows, and words of contacts. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_SETTINGS_H
#define FIBRAD_COUPLE_SETTINGS_H

#include <cerrno>
#include <cstdlib>
#include <string>

#include "couple/fibrad_couple.h"

/* Reads a number from low to high. The whole word must be the number. */
inline bool setting_number(const std::string &word, double low, double high, double *value) {
    char *end;
    *value = std::strtod(word.c_str(), &end);
    return !word.empty() && *end == 0 && *value >= low && *value <= high;
}

/* The same for a whole number. */
template <typename T>
bool setting_whole(const std::string &word, double low, double high, T *value) {
    char *end;
    errno = 0;
    const unsigned long long whole = std::strtoull(word.c_str(), &end, 10);
    *value = (T)whole;
    return word[0] >= '0' && word[0] <= '9' && *end == 0 && errno == 0 && (double)whole >= low && (double)whole <= high;
}

/* An option of rows. One of the members is its field. Without a member it is `accuracy`. */
struct radiation_setting {
    const char *name, *wanted; /* for messages: what its value is */
    double low, high;
    double fibrad_insitu_config::*number;
    uint32_t fibrad_insitu_config::*count;
    int fibrad_insitu_config::*choice; /* a whole number, or yes and no if `high` is 0 */
    uint64_t fibrad_insitu_config::*seed;
};

/* The option with a name. NULL: there is none. */
inline const radiation_setting *setting_named(const std::string &name) {
    using config = fibrad_insitu_config;
    static const radiation_setting settings[] = {
        {"cutoff", "a length of 0 or more", 0, FIBRAD_LENGTH_MAX, &config::cutoff, nullptr, nullptr, nullptr},
        {"tolerance", "within 0 and 1", 0, 1, &config::tolerance, nullptr, nullptr, nullptr},
        {"directions", "a number of directions, 8 to 65536", FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX, nullptr,
         &config::directions, nullptr, nullptr},
        {"paths", "a number of paths above 0", 1, FIBRAD_PATHS_MAX, nullptr, &config::paths, nullptr, nullptr},
        {"threads", "a number of threads, 1 to 1024", 1, 1024, nullptr, nullptr, &config::threads, nullptr},
        {"strict", "yes or no", 0, 0, nullptr, nullptr, &config::strict, nullptr},
        {"seed", "a whole number", 0, 1.8446744073709552e19, nullptr, nullptr, nullptr, &config::seed},
        {"accuracy", "one of low, normal and high", 0, 0, nullptr, nullptr, nullptr, nullptr}};
    for (const radiation_setting &setting : settings)
        if (name == setting.name) return &setting;
    return nullptr;
}

/* Takes the value of an option. False: it is not what is wanted. */
inline bool setting_take(const radiation_setting &s, const std::string &word, fibrad_insitu_config *config) {
    if (s.number != nullptr) return setting_number(word, s.low, s.high, &(config->*s.number));
    if (s.count != nullptr) return setting_whole(word, s.low, s.high, &(config->*s.count));
    if (s.seed != nullptr) return setting_whole(word, s.low, s.high, &(config->*s.seed));
    if (s.choice != nullptr && s.high > 0) return setting_whole(word, s.low, s.high, &(config->*s.choice));
    int *choice = s.choice != nullptr ? &(config->*s.choice) : &config->accuracy;
    *choice = s.choice == nullptr ? fibrad_accuracy_named(word.c_str()) : word == "yes" ? 1 : word == "no" ? 0 : -1;
    return *choice >= 0;
}

/* A word behind the conductivity of contacts. One without a number chooses spots. */
struct contact_setting {
    const char *name, *what; /* for messages: what its number is */
    double low, high;
    double fibrad_insitu_contacts::*number;
    int hertz;
};

/* The word with a name. NULL: there is none. */
inline const contact_setting *contact_named(const std::string &name) {
    static const contact_setting settings[] = {
        {"lens", nullptr, 0, 0, nullptr, 0},
        {"hertz", nullptr, 0, 0, nullptr, 1},
        {"scale", "the scale of contacts", 1e-6, 1e6, &fibrad_insitu_contacts::scale, 0},
        {"gas", "the conductivity of the gas", 0, 1e300, &fibrad_insitu_contacts::gas, 0}};
    for (const contact_setting &setting : settings)
        if (name == setting.name) return &setting;
    return nullptr;
}

#endif
