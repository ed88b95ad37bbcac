// plot.h - a diagram of points in series, for one page or one screen
#ifndef CLI_PLOT_H
#define CLI_PLOT_H

#include <relume/base.h>

struct plot_point {
    double x, y;  // x > 0 unless its axis is linear
    int series;
    bool on_hull;    // joined by the hull's line
    char label[12];  // beside the point where there is room
};

struct plot_series {
    char name[64];
    int colour, mark;  // numbers; series that belong together share one of them
};

struct plot {
    const char *title, *subtitle, *x_label, *y_label;
    const struct plot_series *series;  // [series_count], in the order of the legend
    int series_count;
    const struct plot_point *point;  // points of a series are joined in the order of x
    int points;
    bool linear;  // the axis of x, which is logarithmic otherwise
    bool curves;  // lines alone: no marks, no labels, no hull
};

// STEM.svg and STEM.png. RELUME_EINVAL when there is no point, RELUME_EIO, RELUME_ENOMEM.
relume_status plot_save(const struct plot *plot, const char *stem, const struct relume_log *log);

#endif
