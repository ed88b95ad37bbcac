// statistics.h - probabilities of test statistics
#ifndef STUDY_STATISTICS_H
#define STUDY_STATISTICS_H

#include <relume/site/study.h>

// The probability that a chi squared of that many degrees of freedom, >= 1, is larger.
double relume_study_chi_squared_p(double chi_squared, int freedom);
// The z whose normal distribution is p, in (0, 1).
double relume_study_normal_z(double p);

#endif
