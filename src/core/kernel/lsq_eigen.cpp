// lsq_eigen.cpp - the one file that knows Eigen
//
// It is compiled for the baseline of the CPU, for AVX2 and for AVX-512; LSQ_KERNELS names the
// table. Each object renames Eigen's namespace (Makefile), or the linker would take one of the
// versions of each template for both. Products that find no memory for packing do without it.
//
// Of very small products Eigen works out numbers before the first whole vector otherwise than those
// in vectors: these are plain loops, so that results are the same wherever the memory is.
#include "core/kernel/lsq_kernels.h"

#define EIGEN_DONT_PARALLELIZE
#define EIGEN_MPL2_ONLY
#include <Eigen/Dense>
#include <new>

namespace
{

template <typename T>
using Rows = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
template <typename T> using Strided = Eigen::Map<Rows<T>, 0, Eigen::OuterStride<>>;
using Square = Eigen::Map<Rows<double>>;
using Columns = Eigen::Map<Eigen::MatrixXd>;
using Eigen::Lower;

// Memory runs out as an exception in Eigen, and as `false` here.
template <typename F> bool with_memory(F work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return false;
    }
}

template <typename C, typename A, typename B> void small_product(C &c, const A &a, const B &b)
{
    for (Eigen::Index i = 0; i < c.rows(); i++)
        for (Eigen::Index j = 0; j < c.cols(); j++) {
            c(i, j) = 0;
            for (Eigen::Index k = 0; k < a.cols(); k++)
                c(i, j) += a(i, k) * b(k, j);
        }
}

template <typename C, typename A, typename B> void product(C &c, const A &a, const B &b)
{
    if (c.rows() + c.cols() + a.cols() < EIGEN_GEMM_TO_COEFFBASED_THRESHOLD || c.size() == 1) {
        small_product(c, a, b);
        return;
    }
    const bool done = with_memory([&] {
        c.noalias() = a * b;
        return true;
    });
    if (!done)
        c = a.lazyProduct(b);
}

template <typename T> void multiply(lsq_shape s, const T *a, const T *b, T *c)
{
    using In = Eigen::Map<const Rows<T>, 0, Eigen::OuterStride<>>;
    const In left(a, s.turn_a ? s.k : s.m, s.turn_a ? s.m : s.k, Eigen::OuterStride<>(s.lda));
    const In right(b, s.turn_b ? s.n : s.k, s.turn_b ? s.k : s.n, Eigen::OuterStride<>(s.ldb));
    Strided<T> out(c, s.m, s.n, Eigen::OuterStride<>(s.ldc));
    if (s.turn_a && s.turn_b)
        product(out, left.transpose(), right.transpose());
    else if (s.turn_a)
        product(out, left.transpose(), right);
    else if (s.turn_b)
        product(out, left, right.transpose());
    else
        product(out, left, right);
}

void add_gram(double *gram, int n, const double *rows, int count)
{
    Square sum(gram, n, n);
    const Eigen::Map<const Rows<double>> r(rows, count, n);
    const bool done = with_memory([&] {
        sum.selfadjointView<Lower>().rankUpdate(r.transpose());
        return true;
    });
    if (!done)
        sum.triangularView<Lower>() += r.transpose().lazyProduct(r);
}

bool eigen(const double *matrix, int n, int count, double *values, double *vectors)
{
    return with_memory([&] {
        const Eigen::Map<const Rows<double>> m(matrix, n, n);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
            m, vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
        if (solver.info() != Eigen::Success)
            return false;
        for (int i = 0; i < count; i++) {
            values[i] = solver.eigenvalues()[n - 1 - i];
            if (vectors)
                Columns(vectors + static_cast<size_t>(i) * n, n, 1) =
                    solver.eigenvectors().col(n - 1 - i);
        }
        return true;
    });
}

bool cholesky(double *matrix, int n)
{
    return with_memory([&] {
        Square m(matrix, n, n);
        const Eigen::LLT<Eigen::Ref<Rows<double>>> factor(m);
        return factor.info() == Eigen::Success && (m.diagonal().array() > 0.0).all();
    });
}

bool cholesky_solve(const double *factor, int n, double *b, int count)
{
    return with_memory([&] {
        const Eigen::Map<const Rows<double>> l(factor, n, n);
        Columns x(b, n, count);
        l.triangularView<Lower>().solveInPlace(x);
        l.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
        return true;
    });
}

bool invert_lower(double *factor, int n)
{
    return with_memory([&] {
        Square l(factor, n, n);
        Rows<double> inverse = Rows<double>::Identity(n, n);
        l.triangularView<Lower>().solveInPlace(inverse);
        l.triangularView<Lower>() = inverse;
        return (l.diagonal().array().isFinite()).all();
    });
}

bool invert(double *matrix, int n, bool *singular)
{
    return with_memory([&] {
        Square m(matrix, n, n);
        const Eigen::PartialPivLU<Rows<double>> lu(m);
        *singular = !(lu.matrixLU().diagonal().array().abs() > 0.0).all();
        if (!*singular)
            m = lu.inverse();
        return true;
    });
}

}  // namespace

const lsq_kernels LSQ_KERNELS = {multiply<float>, multiply<double>, add_gram,     eigen,
                                 cholesky,        cholesky_solve,   invert_lower, invert};
