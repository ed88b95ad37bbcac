// btf_report.h - the rows of `relume btf compare` and `eval`
#ifndef CLI_BTF_REPORT_H
#define CLI_BTF_REPORT_H

#include "cli/cli.h"

// What is known of one fitted model.
struct btf_row {
    struct relume_btf_fitted_info info;
    struct relume_btf_error error;
    struct relume_btf_cost cost;
    double fit_s;                             // NaN: not known
    double evaluations;                       // a second, on one core
    const struct relume_btf_error *held_out;  // NULL: not measured
};

// Evaluations a second between measured directions, on this core.
double btf_speed(const relume_btf_fitted *fitted);

void btf_heading(bool held_out);
void btf_print(const struct btf_row *row);
void btf_put_row(struct jwriter *w, const struct btf_row *row);

#endif
