// exchange_request.h - a picture of light between a scene and objects, as it is asked for
#ifndef VIEWER_EXCHANGE_REQUEST_H
#define VIEWER_EXCHANGE_REQUEST_H

#include <relume/frame.h>
#include <relume/world/object.h>

struct exchange_request {
    const struct relume_transport *transport;
    int samples, bounces;         // as relume_render_params
    struct relume_camera camera;  // with a width and a height
    enum relume_interpolation interpolation;
    double aperture, focus;             // as relume_frame_params
    const struct relume_light *lights;  // borrowed during a call; what they point at stays
    int count;                          // of lights
    bool moves;                         // under the hand: a rough picture will do
    bool waits;                         // for the fine one: there need be no rough one
};

// A copy owns its lights; false: no memory. One that was forgotten has no transport.
bool exchange_request_copy(struct exchange_request *out, const struct exchange_request *q);
void exchange_request_forget(struct exchange_request *q);

// In the same way; from the same eye, too; and under the same lights.
bool exchange_same_way(const struct exchange_request *a, const struct exchange_request *b);
bool exchange_same_eye(const struct exchange_request *a, const struct exchange_request *b);
bool exchange_same_request(const struct exchange_request *a, const struct exchange_request *b);

#endif
