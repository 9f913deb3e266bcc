#include "ingest/formats/motions/joint_array.hpp"

#include <algorithm>
#include <bit>

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr std::uint64_t most_guessed_persons = 6;

/// Empty where nothing fits.
std::string usual_axes(const std::vector<std::uint64_t>& shape, std::size_t joints) {
    const auto rank = shape.size();
    if (rank == 2) return shape[1] == joints * 3 ? "tk" : "";
    if (rank < 3 || rank > 5 || shape[rank - 1] != 3 || shape[rank - 2] != joints) return "";
    if (rank == 3) return "tkc";
    if (rank == 5) return "ntpkc";
    return shape[1] <= most_guessed_persons && shape[1] <= shape[0] ? "tpkc" : "ntkc";
}

}  // namespace

void check_axes(const std::string& axes) {
    const auto count = [&](char letter) { return std::count(axes.begin(), axes.end(), letter); };
    const bool known = axes.find_first_not_of("ntpkc") == std::string::npos;
    if (axes.empty() || (known && count('n') <= 1 && count('t') == 1 && count('p') <= 1 && count('k') == 1 &&
                         count('c') <= 1))
        return;
    throw Error(
        "axes {}: give a letter an axis of the arrays: n clips, t frames, p persons, k joints, c "
        "coordinates, as in "
        "tkc, ntpkc, nctkp, or tk where x, y, z of the joints share an axis",
        in_quotes(axes));
}

JointArray::JointArray(const NumpyArray& array, std::size_t joints, const std::string& axes)
    : array_(&array), joints_(joints) {
    if (!array.numbers()) throw Error("an array of type {}, which is no number", in_quotes(array.type));
    const auto order = axes.empty() ? usual_axes(array.shape, joints) : axes;
    guessed_ = axes.empty() && order.size() == 4;
    const bool coordinates = order.find('c') != std::string::npos;
    bool fits = !order.empty() && order.size() == array.shape.size();
    for (std::size_t i = 0; i < order.size() && fits; ++i)
        fits = order[i] == 'k'   ? array.shape[i] == (coordinates ? joints : joints * 3)
               : order[i] == 'c' ? array.shape[i] == 3
                                 : array.shape[i] > 0;
    if (!fits)
        throw Error(
            "{} is no array of {} joints: {}; see --topology and --axes", array.shape_text(), joints,
            axes.empty()
                ? fmt::format("(T, {0}, 3), (T, P, {0}, 3), (N, T, {0}, 3) or (N, T, P, {0}, 3) is", joints)
                : fmt::format("the axes are to be {}", axes));
    std::uint64_t stride = 1;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto axis = array.fortran_order ? i : order.size() - 1 - i;
        take_axis(order[axis], array.shape[axis], stride);
        stride *= array.shape[axis];
    }
    if (!coordinates) {
        of_coordinate_ = of_joint_;
        of_joint_ *= 3;
    }
}

void JointArray::take_axis(char letter, std::uint64_t length, std::uint64_t stride) {
    switch (letter) {
        case 'n':
            clips_ = length;
            of_clip_ = stride;
            has_clips_ = true;
            return;
        case 't':
            frames_ = length;
            of_frame_ = stride;
            return;
        case 'p':
            persons_ = length;
            of_person_ = stride;
            return;
        case 'k':
            of_joint_ = stride;
            return;
        default:
            of_coordinate_ = stride;
    }
}

const char* JointArray::end_of_clip(std::uint64_t clip) const {
    const auto largest = std::max({of_frame_, of_person_, of_joint_, of_coordinate_});
    return array_->values.data() +
           (has_clips_ && of_clip_ > largest ? (clip + 1) * of_clip_ * array_->size : 0);
}

const float* JointArray::as_it_lies(std::uint64_t clip, std::uint64_t frame) const {
    const auto body = std::uint64_t{joints_} * 3;
    const bool floats = array_->kind == NumpyArray::Kind::real && array_->size == sizeof(float) &&
                        !array_->big_endian && std::endian::native == std::endian::little;
    const bool in_order = of_coordinate_ == 1 && of_joint_ == 3 && (persons_ == 1 || of_person_ == body) &&
                          (frames_ == 1 || of_frame_ == persons_ * body);
    const auto* at = array_->values.data() + (clip * of_clip_ + frame * of_frame_) * sizeof(float);
    const bool aligned = reinterpret_cast<std::uintptr_t>(at) % alignof(float) == 0;
    return floats && in_order && aligned ? reinterpret_cast<const float*>(at) : nullptr;
}

void JointArray::pose(std::uint64_t clip, std::uint64_t frame, std::uint64_t person, double* to) const {
    const auto first = clip * of_clip_ + frame * of_frame_ + person * of_person_;
    if (of_coordinate_ == 1 && of_joint_ == 3) return array_->copy(first, 1, joints_ * 3, to);
    double along[3];
    for (std::size_t j = 0; j < joints_; ++j) {
        array_->copy(first + j * of_joint_, of_coordinate_, 3, along);
        std::copy(along, along + 3, to + 3 * j);
    }
}

}  // namespace actformer::ingest
