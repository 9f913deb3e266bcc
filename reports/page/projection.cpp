#include "reports/page/projection.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace actformer::reports {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double unit = 4096, furthest = 7.999;  // deviations that 16 bits hold
constexpr std::size_t most_points = 1200;        // that a chart can show apart
constexpr std::size_t most_dimensions = 4096;    // whose covariance, their square, is found in a minute

/// What samples must be to have axes. Throws Error before any memory is taken.
std::size_t dimensions_of(const eval::Samples& real) {
    if (real.dimensions > most_dimensions)
        throw Error("features of {} dimensions, and a plane through up to {} is drawn", real.dimensions,
                    most_dimensions);
    return real.dimensions;
}

Eigen::Map<const Rows> matrix_of(const eval::Samples& samples) {
    return {samples.features.data(), static_cast<Eigen::Index>(samples.size()),
            static_cast<Eigen::Index>(samples.dimensions)};
}

}  // namespace

Projection::Projection(const eval::Samples& real)
    : dimensions_(dimensions_of(real)), mean_(dimensions_), axes_(2 * dimensions_) {
    const auto x = matrix_of(real);
    Eigen::Map<Eigen::RowVectorXd> mean(mean_.data(), static_cast<Eigen::Index>(dimensions_));
    mean = x.colwise().mean();
    const Rows centred = x.rowwise() - mean;
    const Eigen::MatrixXd covariance =
        centred.transpose() * centred / static_cast<double>(std::max<Eigen::Index>(x.rows() - 1, 1));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
    const auto all = solver.eigenvalues().cwiseMax(0).sum();
    for (std::size_t a = 0; a < 2 && a < dimensions_; ++a) {
        const auto at = static_cast<Eigen::Index>(dimensions_ - 1 - a);  // largest last
        const double value = std::max(solver.eigenvalues()[at], 0.0);
        explained_[a] = all > 0 ? value / all : 0;
        Eigen::VectorXd axis = solver.eigenvectors().col(at);
        Eigen::Index largest = 0;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis[largest] < 0) axis = -axis;  // an axis has two directions: take one
        if (value > 0) axis /= std::sqrt(value);
        std::copy_n(axis.data(), dimensions_, axes_.begin() + static_cast<std::ptrdiff_t>(a * dimensions_));
    }
    real_ = of(real);
}

Points Projection::of(const eval::Samples& samples) const {
    if (samples.dimensions != dimensions_)
        throw Error("features of {} dimensions beside real ones of {}", samples.dimensions, dimensions_);
    Points out;
    const auto stride = std::max<std::size_t>(1, (samples.size() + most_points - 1) / most_points);
    for (std::size_t i = 0; i < samples.size(); i += stride) {
        const double* x = &samples.features[i * dimensions_];
        for (std::size_t a = 0; a < 2; ++a) {
            double sum = 0;
            for (std::size_t d = 0; d < dimensions_; ++d)
                sum += axes_[a * dimensions_ + d] * (x[d] - mean_[d]);
            out.xy.push_back(
                static_cast<std::int16_t>(std::lround(unit * std::clamp(sum, -furthest, furthest))));
        }
        out.labels.push_back(static_cast<std::uint16_t>(std::min<std::uint32_t>(samples.labels[i], 65535)));
    }
    return out;
}

}  // namespace actformer::reports
