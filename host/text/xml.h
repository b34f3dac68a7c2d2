/* xml.h - tags of XML and their attributes. SPDX-License-Identifier: MIT */
#ifndef XML_H
#define XML_H

#include <stdbool.h>

enum { XML_WORD = 1000 }; /* room of a value, with the 0 at its end */

/* A tag, without its < and >. */
struct xml_tag {
    const char *text, *end;
};

bool xml_is(const struct xml_tag *tag, const char *name);

/* Finds the next tag before `end` that is no comment, and moves *at behind it. False: there is none. */
bool xml_next(const char **at, const char *end, struct xml_tag *tag);

/* The value of an attribute, of at most XML_WORD - 1 characters. "": the tag does not have the attribute. */
const char *xml_attribute(const struct xml_tag *tag, const char *name, char value[XML_WORD]);

#endif
