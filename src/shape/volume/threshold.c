// threshold.c - where the samples of a volume fall into two kinds (Otsu 1979)
#include "shape/volume/volume.h"

enum { BINS = 1024 };

// Whole numbers have bins of their own as long as there are few.
static int bins_of(const relume_volume *v)
{
    const double values = (double)v->max - (double)v->min + 1.0;
    return v->type != VOLUME_F32 && values < BINS ? (int)values : BINS;
}

static void count(uint64_t *histogram, int bins, const relume_volume *v)
{
    const size_t samples = volume_at(v, 0, 0, v->size[2]);
    const double scale = (bins - 1) / ((double)v->max - (double)v->min);
    for (size_t i = 0; i < samples; i++)
        histogram[(int)(((double)volume_sample(v, i) - (double)v->min) * scale + 0.5)]++;
}

double relume_volume_threshold(const relume_volume *v)
{
    uint64_t histogram[BINS] = {0};
    const int bins = bins_of(v);
    double count_all = 0.0, sum_all = 0.0, low = 0.0, sum_low = 0.0, most = -1.0;
    int first = 1, last = 1;  // bins at which the upper kind may begin
    count(histogram, bins, v);
    for (int i = 0; i < bins; i++) {
        count_all += (double)histogram[i];
        sum_all += (double)histogram[i] * i;
    }
    for (int i = 1; i < bins; i++) {
        low += (double)histogram[i - 1];
        sum_low += (double)histogram[i - 1] * (i - 1);
        const double high = count_all - low;
        const double apart = sum_low / low - (sum_all - sum_low) / high;
        const double variance = low * high * apart * apart;
        if (variance > most) {
            most = variance;
            first = i;
        }
        if (variance >= most)
            last = i;
    }
    const double bin = ((double)v->max - (double)v->min) / (bins - 1);
    return (double)v->min + (0.5 * (first + last) - 0.5) * bin;
}
