// btf_report.h - the rows of `relume btf compare` and `eval`
#ifndef BTF_REPORT_H
#define BTF_REPORT_H

#include "cli.h"

void btf_heading(bool held_out);
// `held_out` NULL: not measured.
void btf_row(const struct relume_btf_fitted_info *info, const struct relume_btf_error *e,
             double fit_s, const struct relume_btf_error *held_out);
void btf_json_row(const struct relume_btf_fitted_info *info, const struct relume_btf_error *e,
                  double fit_s, const struct relume_btf_error *held_out);

#endif
