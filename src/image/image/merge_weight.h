// merge_weight.h - weights of an exposure bracket and the inverse of a response
#ifndef IMAGE_MERGE_WEIGHT_H
#define IMAGE_MERGE_WEIGHT_H

#include <relume/image/response.h>

// The inverse, in [0, 1].
float relume_response_encode(const struct relume_response *response, int channel, float exposure);

// The weight of a code in an exposure that is the longest, the shortest, or neither.
float relume_merge_weight(enum relume_merge_weights weights, float code, bool longest,
                          bool shortest);

#endif
