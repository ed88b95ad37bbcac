// Samples of what a pixel covers. Twin: src/image/image/footprint.h.
const int FOOTPRINT_MOST = 16;  // a side
const float FOOTPRINT_SLACK = 1e-4;
const float FOOTPRINT_ONE = 1.25;

struct Footprint {
    int count;
    float step;  // from sample to sample, of a pixel
};

Footprint footprint_of(float texels)
{
    if (!(texels > FOOTPRINT_ONE))
        return Footprint(1, 0.0);
    float r = texels < 2.0 ? 1.0 + (texels - FOOTPRINT_ONE) / (2.0 - FOOTPRINT_ONE) : texels;
    float whole = clamp(ceil(r - FOOTPRINT_SLACK), 2.0, float(FOOTPRINT_MOST));
    return Footprint(int(whole), sqrt((r * r - 1.0) / (whole * whole - 1.0)) / texels);
}

float footprint_place(Footprint f, int i)
{
    return (float(i) - 0.5 * float(f.count - 1)) * f.step;
}
