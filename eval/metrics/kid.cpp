#include "eval/metrics/kid.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"

namespace actformer::eval {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Rows = Eigen::Ref<const Matrix>;

constexpr Eigen::Index block = 256;  // rows of either side that meet at once

Matrix rows_of(const Samples& samples, const std::vector<std::size_t>& which) {
    Matrix out(static_cast<Eigen::Index>(which.size()), static_cast<Eigen::Index>(samples.dimensions));
    for (std::size_t i = 0; i < which.size(); ++i) {
        const auto from = features_of(samples, which[i]);
        std::copy(from.begin(), from.end(), out.row(static_cast<Eigen::Index>(i)).data());
    }
    return out;
}

/// The sum of k over all pairs of rows, a block of x after another and added up in their order.
double kernel_sum(const Matrix& x, const Matrix& y, unsigned threads) {
    const double scale = 1 / static_cast<double>(x.cols());
    std::vector<double> sums(static_cast<std::size_t>((x.rows() + block - 1) / block), 0);
    parallel_for(sums.size(), thread_count(threads), [&](std::size_t i, unsigned) {
        const auto first = static_cast<Eigen::Index>(i) * block;
        const auto here = x.middleRows(first, std::min(block, x.rows() - first));
        for (Eigen::Index at = 0; at < y.rows(); at += block) {
            const Matrix products = here * y.middleRows(at, std::min(block, y.rows() - at)).transpose();
            sums[i] += (products.array() * scale + 1).cube().sum();
        }
    });
    double sum = 0;
    for (const auto part : sums) sum += part;
    return sum;
}

/// The mean of k over pairs of different rows.
double mean_within(const Matrix& x, unsigned threads) {
    const auto n = static_cast<double>(x.rows());
    const double with_itself =
        (x.rowwise().squaredNorm().array() / static_cast<double>(x.cols()) + 1).cube().sum();
    return (kernel_sum(x, x, threads) - with_itself) / (n * (n - 1));
}

double discrepancy(const Matrix& x, const Matrix& y, unsigned threads) {
    const auto pairs = static_cast<double>(x.rows()) * static_cast<double>(y.rows());
    return mean_within(x, threads) + mean_within(y, threads) - 2 * kernel_sum(x, y, threads) / pairs;
}

void check_dimensions(const Samples& real, const Samples& generated) {
    if (real.dimensions != generated.dimensions)
        throw Error("features of {} and of {} dimensions cannot be compared", real.dimensions,
                    generated.dimensions);
}

}  // namespace

std::optional<double> kid(const Samples& real, const Samples& generated, unsigned threads) {
    check_dimensions(real, generated);
    if (real.size() < 2 || generated.size() < 2) return {};
    return discrepancy(rows_of(real, all_indices(real.size())),
                       rows_of(generated, all_indices(generated.size())), threads);
}

std::optional<double> kid_mean(const Samples& real, const Samples& generated, unsigned threads) {
    check_dimensions(real, generated);
    const auto of_real = members_by_class(real), of_generated = members_by_class(generated);
    double sum = 0;
    std::size_t measured = 0;
    for (std::size_t c = 0; c < std::min(of_real.size(), of_generated.size()); ++c) {
        if (of_real[c].size() < 2 || of_generated[c].size() < 2) continue;
        sum += discrepancy(rows_of(real, of_real[c]), rows_of(generated, of_generated[c]), threads);
        ++measured;
    }
    if (measured == 0) return {};
    return sum / static_cast<double>(measured);
}

}  // namespace actformer::eval
