#include "eval/metrics/frechet.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"

namespace actformer::eval {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// R of the QR decomposition: R^T R = A^T A, with at most as many rows as columns.
MatrixXd triangle(const MatrixXd& a) {
    const Eigen::HouseholderQR<MatrixXd> qr(a);
    const Index rows = std::min(a.rows(), a.cols());
    MatrixXd r = qr.matrixQR().topRows(rows);
    return r.triangularView<Eigen::Upper>();
}

/// Fewer rows with the same A^T A, which many rows allow: each block's triangle, then the triangle of the triangles. The
/// blocks are the same on any number of threads, and so are the numbers.
Rows shrink(Rows a, unsigned threads) {
    const Index d = a.cols(), block = 4 * d;
    while (a.rows() > 2 * d) {
        const Index blocks = (a.rows() + block - 1) / block;
        std::vector<MatrixXd> triangles(static_cast<std::size_t>(blocks));
        parallel_for(triangles.size(), threads, [&](std::size_t i, unsigned) {
            const Index first = static_cast<Index>(i) * block;
            triangles[i] = triangle(a.middleRows(first, std::min(block, a.rows() - first)));
        });
        Index rows = 0;
        for (const auto& r : triangles) rows += r.rows();
        a.resize(rows, d);
        rows = 0;
        for (const auto& r : triangles) {
            a.middleRows(rows, r.rows()) = r;
            rows += r.rows();
        }
    }
    return a;
}

/// Householder reflections from both sides make a square matrix upper bidiagonal, with the same singular values.
struct Bidiagonal {
    VectorXd diagonal, above;
};

Bidiagonal bidiagonalise(MatrixXd a) {
    const Index n = a.rows();
    Bidiagonal out{VectorXd(n), VectorXd(std::max<Index>(n - 1, 0))};
    VectorXd workspace(n);
    double tau = 0;
    for (Index k = 0; k < n; ++k) {
        a.col(k).tail(n - k).makeHouseholderInPlace(tau, out.diagonal[k]);
        if (k + 1 == n) break;
        a.bottomRightCorner(n - k, n - k - 1)
            .applyHouseholderOnTheLeft(a.col(k).tail(n - k - 1), tau, workspace.data());
        a.row(k).tail(n - k - 1).makeHouseholderInPlace(tau, out.above[k]);
        a.bottomRightCorner(n - k - 1, n - k - 1)
            .applyHouseholderOnTheRight(a.row(k).tail(n - k - 2).transpose(), tau, workspace.data());
    }
    return out;
}

/// The singular values' sum. The symmetric tridiagonal matrix with zeros on its diagonal and d0 e0 d1 e1 .. beside it has
/// the eigenvalues +s and -s for every singular value s. Unlike the square roots of A^T A's, they are good to the last
/// digits of the largest one.
double nuclear_norm(const MatrixXd& a) {
    if (a.size() == 0) return 0;
    MatrixXd square = a.rows() >= a.cols() ? triangle(a) : triangle(a.transpose());
    const double scale = square.cwiseAbs().maxCoeff();
    if (scale == 0) return 0;
    const auto b = bidiagonalise(square / scale);
    const Index n = b.diagonal.size();
    VectorXd beside(2 * n - 1);
    for (Index i = 0; i < 2 * n - 1; ++i) beside[i] = i % 2 == 0 ? b.diagonal[i / 2] : b.above[i / 2];
    const double largest = beside.cwiseAbs().maxCoeff();
    for (auto& value : beside)  // noise, over which the iteration would only brood
        if (std::abs(value) < 1e-16 * largest) value = 0;
    Eigen::SelfAdjointEigenSolver<MatrixXd> solver;
    solver.computeFromTridiagonal(VectorXd::Zero(2 * n), beside, Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success)
        throw Error("the singular values of a {} x {} matrix of features were not found", a.rows(), a.cols());
    return scale * solver.eigenvalues().cwiseAbs().sum() / 2;
}

Eigen::Map<const Rows> rows_of(const Moments& m) {
    const auto d = static_cast<Index>(m.dimensions());
    return {m.factor.data(), static_cast<Index>(m.factor.size()) / d, d};
}

}  // namespace

Moments fit(std::span<const double> samples, std::size_t dimensions, unsigned threads) {
    if (dimensions == 0 || samples.size() % dimensions != 0)
        throw Error("{} numbers are no whole samples of {} dimensions", samples.size(), dimensions);
    const auto n = samples.size() / dimensions;
    if (n < 2) throw Error("{} samples are too few: a covariance takes at least two", n);
    const Eigen::Map<const Rows> given(samples.data(), static_cast<Index>(n), static_cast<Index>(dimensions));
    const Eigen::RowVectorXd mean = given.colwise().mean();
    Rows centred = given.rowwise() - mean;
    const double scatter = centred.squaredNorm();
    if (!std::isfinite(scatter)) throw Error("the samples hold numbers that are not finite");
    const auto factor = shrink(std::move(centred), thread_count(threads));
    Moments out;
    out.samples = n;
    out.mean.assign(mean.begin(), mean.end());
    out.variance = scatter / static_cast<double>(n - 1);
    out.factor.assign(factor.data(), factor.data() + factor.size());
    return out;
}

double frechet_distance(const Moments& x, const Moments& y) {
    if (x.dimensions() != y.dimensions())
        throw Error("samples of {} and {} dimensions cannot be compared", x.dimensions(), y.dimensions());
    const Eigen::Map<const VectorXd> mean_x(x.mean.data(), static_cast<Index>(x.dimensions())),
        mean_y(y.mean.data(), static_cast<Index>(y.dimensions()));
    const double degrees = std::sqrt(static_cast<double>(x.samples - 1) * static_cast<double>(y.samples - 1));
    const double cross = nuclear_norm(rows_of(x) * rows_of(y).transpose()) / degrees;
    const double variances = x.variance + y.variance;
    const double distance = (mean_x - mean_y).squaredNorm() + variances - 2 * cross;
    return distance <= 1e-13 * variances ? 0 : distance;
}

}  // namespace actformer::eval
