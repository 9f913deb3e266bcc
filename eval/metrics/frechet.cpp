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

/// Samples less their mean, in blocks of rows. The blocks are the same on any number of threads, and so are the numbers.
class Centred {
  public:
    Centred(Eigen::Map<const Rows> given, unsigned threads)
        : given_(given), mean_(given.colwise().mean()), threads_(threads) {
        constexpr Index least = 1024, most_blocks = 64;
        rows_ = std::max(least, (given.rows() + most_blocks - 1) / most_blocks);
    }

    Index dimensions() const { return given_.cols(); }
    const Eigen::RowVectorXd& mean() const { return mean_; }
    Rows whole() const { return given_.rowwise() - mean_; }

    /// What `of` gives of each block.
    template <typename Result, typename Of>
    std::vector<Result> each(Of of) const {
        std::vector<Result> out(static_cast<std::size_t>((given_.rows() + rows_ - 1) / rows_));
        parallel_for(out.size(), threads_, [&](std::size_t i, unsigned) {
            const Index first = static_cast<Index>(i) * rows_;
            const Rows block =
                given_.middleRows(first, std::min(rows_, given_.rows() - first)).rowwise() - mean_;
            out[i] = of(block);
        });
        return out;
    }

  private:
    Eigen::Map<const Rows> given_;
    Eigen::RowVectorXd mean_;
    unsigned threads_;
    Index rows_;
};

/// A^T A of the samples times `by` (d, d), upper triangular.
MatrixXd gram(const Centred& samples, const MatrixXd* by = nullptr) {
    const Index d = samples.dimensions();
    MatrixXd sum = MatrixXd::Zero(d, d);
    for (const auto& part : samples.each<MatrixXd>([&](const Rows& block) {
             MatrixXd product = MatrixXd::Zero(d, d);
             if (by) {
                 const Rows turned = block * by->triangularView<Eigen::Upper>();
                 product.selfadjointView<Eigen::Lower>().rankUpdate(turned.transpose());
             } else {
                 product.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
             }
             return product;
         }))
        sum += part;
    return sum;
}

/// R with R^T R = `gram`; none where it is not positive definite.
std::optional<MatrixXd> cholesky(const MatrixXd& gram) {
    const Eigen::LLT<MatrixXd> llt(gram);
    if (llt.info() != Eigen::Success) return {};
    return MatrixXd(llt.matrixU());
}

/// The triangle of many samples. R of A^T A by Cholesky takes a sixth of a QR's time but feels the condition k of A: what it
/// costs the distance stays below 1e-15 k of the variances. Above 1e4 a second round on A R^-1 mends it (CholeskyQR2: Yamamoto et
/// al., ETNA 44, 2015), and above 1e7 Householder's reflections take over: each block's triangle, then that of the triangles.
MatrixXd triangle_of(const Centred& samples) {
    constexpr double mild = 1e4, hard = 1e7;
    const Index d = samples.dimensions();
    if (const auto first = cholesky(gram(samples))) {
        const MatrixXd inverse = first->triangularView<Eigen::Upper>().solve(MatrixXd::Identity(d, d));
        const double condition =
            first->norm() * inverse.norm();  // in Frobenius' norm: no less than the condition
        if (condition < mild) return *first;
        if (condition < hard)
            if (const auto second = cholesky(gram(samples, &inverse)))
                return second->triangularView<Eigen::Upper>() * *first;
    }
    const auto triangles = samples.each<MatrixXd>([](const Rows& block) { return triangle(block); });
    Index rows = 0;
    for (const auto& r : triangles) rows += r.rows();
    MatrixXd stacked(rows, d);
    rows = 0;
    for (const auto& r : triangles) {
        stacked.middleRows(rows, r.rows()) = r;
        rows += r.rows();
    }
    return triangle(stacked);
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
    for (auto& value : beside)  // rounding, on which the iteration would spend most of its steps
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
    const Centred centred(given, thread_count(threads));
    double scatter = 0;
    for (const double part : centred.each<double>([](const Rows& block) { return block.squaredNorm(); }))
        scatter += part;
    if (!std::isfinite(scatter)) throw Error("the samples hold numbers that are not finite");
    const Rows factor = n > 2 * dimensions ? Rows(triangle_of(centred)) : centred.whole();
    Moments out;
    out.samples = n;
    out.mean.assign(centred.mean().begin(), centred.mean().end());
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
