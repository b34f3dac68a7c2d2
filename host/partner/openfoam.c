/* openfoam.c - to come. SPDX-License-Identifier: MIT */
#include "cli/message.h"
#include "partner/partner.h"

static int openfoam_plan(struct exchange *e) {
    (void)e;
    return message(STATUS_USAGE, "--openfoam: not yet");
}

const struct partner partner_openfoam = {openfoam_plan, NULL, NULL, NULL, NULL, NULL};
