/* xml.h - tags of XML and their attributes. SPDX-License-Identifier: MIT */
#ifndef XML_H
#define XML_H

#include <stdbool.h>

enum { XML_WORD = 1000 }; /* room of a value, with the 0 at its end */

/* A tag: text to before end, without < and >. */
struct xml_tag {
    const char *text, *end;
};

/* Whether a tag has this name. The name of an end tag begins with /. */
bool xml_is(const struct xml_tag *tag, const char *name);

/* Finds the next tag from *at to before `end`, and moves *at behind it. Skips comments. False: there is none. */
bool xml_next(const char **at, const char *end, struct xml_tag *tag);

/* Copies the value of an attribute into `value`, and returns it. "": the tag does not have it. A value of XML_WORD
 * characters or more is cut. */
const char *xml_attribute(const struct xml_tag *tag, const char *name, char value[XML_WORD]);

#endif
