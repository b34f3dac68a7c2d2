/* xml.c - tags of XML and their attributes. SPDX-License-Identifier: MIT */
#include "text/xml.h"

#include <ctype.h>
#include <string.h>

bool xml_is(const struct xml_tag *tag, const char *name) {
    const size_t length = strlen(name);
    return (size_t)(tag->end - tag->text) >= length && memcmp(tag->text, name, length) == 0 &&
           (tag->text + length == tag->end || !isalnum((unsigned char)tag->text[length]));
}

bool xml_next(const char **at, const char *end, struct xml_tag *tag) {
    const char *open = memchr(*at, '<', (size_t)(end - *at));
    if (!open) return false;
    const bool comment = end - open > 4 && memcmp(open, "<!--", 4) == 0;
    char quote = 0;
    for (const char *c = tag->text = open + 1; c < end; ++c) {
        if (comment ? *c == '>' && memcmp(c - 2, "--", 2) == 0 : !quote && *c == '>') {
            tag->end = c;
            *at = c + 1;
            return comment ? xml_next(at, end, tag) : true;
        }
        if (*c == '"' || *c == '\'') quote = quote == *c ? 0 : quote ? quote : *c;
    }
    return false;
}

const char *xml_attribute(const struct xml_tag *tag, const char *name, char value[XML_WORD]) {
    const size_t length = strlen(name);
    value[0] = 0;
    for (const char *c = tag->text; c + length + 2 < tag->end; ++c) {
        if (!isspace((unsigned char)*c) || memcmp(c + 1, name, length) != 0 || c[length + 1] != '=') continue;
        const char *from = c + length + 3;
        size_t size = 0;
        while (from + size < tag->end && from[size] != from[-1] && size < XML_WORD - 1) ++size;
        memcpy(value, from, size);
        value[size] = 0;
        break;
    }
    return value;
}
