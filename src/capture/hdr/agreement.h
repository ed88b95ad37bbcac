// agreement.h - how the exposures of a bracket agree with each other
#ifndef HDR_AGREEMENT_H
#define HDR_AGREEMENT_H

#include <relume/image/response.h>

// Fills report[n] (or NULL). RELUME_EUNFIT when no exposure resolves any pixel, RELUME_ENOMEM.
relume_status agreement(struct relume_exposure_report *report, const struct relume_image *codes,
                        const double *exposures, int n, const struct relume_response *response,
                        const struct relume_merge_params *params);

#endif
