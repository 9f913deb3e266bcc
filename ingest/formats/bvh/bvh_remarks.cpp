#include "ingest/formats/bvh/bvh_remarks.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text/first_few.hpp"

namespace actformer::ingest {
namespace {

constexpr double smallest_body = 0.8, largest_body = 2.5;  // metres, of a body
constexpr double other_unit = 2.2;  // times as large or as small: centimetres and inches are 2.54 apart

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// 0, 1 or 2, of x, y, z.
std::size_t axis_of(Up up) {
    switch (up) {
        case Up::x:
        case Up::minus_x:
            return 0;
        case Up::y:
        case Up::minus_y:
            return 1;
        default:
            return 2;
    }
}

/// "1.72 m", "0.9 cm".
std::string length(double metres) {
    if (metres >= 0.1 && metres < 1000) return fmt::format("{:.2f} m", metres);
    if (metres >= 0.001 && metres < 0.1) return fmt::format("{:.1f} cm", 100 * metres);
    return fmt::format("{:.3g} m", metres);
}

/// "1 file", "2 files", "all 3 files".
std::string files_of(std::size_t some, std::size_t all) {
    return fmt::format("{}{} file{}", some == all && all > 1 ? "all " : "", some, some == 1 ? "" : "s");
}

}  // namespace

std::string root_remark(const Topology& topology, const Recording& example) {
    const auto& top = example.joints[0].name;
    return fmt::format("root '{}'{}, {} joints", topology.names[0],
                       topology.names[0] == top ? "" : fmt::format(" below '{}'", top), topology.joints());
}

std::string skeleton_remark(std::size_t files, const std::vector<std::string>& others) {
    return fmt::format(
        "left out for another skeleton than that of {}: {} ({}); rejected.csv names the first difference of "
        "each",
        files_of(files, 0), files_of(others.size(), 0), first_few(others));
}

Doubts::Doubts(const std::vector<const SurveyedFile*>& files, Up up) : files_(files), up_(up) {
    Vector3 direction{};
    std::vector<double> sizes;
    for (const auto* file : files) {
        sizes.push_back(file->stance.size);
        if (file->stance.upright)
            for (std::size_t d = 0; d < 3; ++d) direction[d] += (*file->stance.upright)[d];
    }
    size_ = median(sizes);
    // A body that bends over or lies down for a while still points up on average.
    const double whole = std::hypot(direction[0], direction[1], direction[2]);
    const auto nearest = nearest_up(direction);
    const double along =
        (up == Up::minus_x || up == Up::minus_y || up == Up::minus_z ? -1 : 1) * direction[axis_of(up)];
    if (whole > 0.5 * static_cast<double>(files.size()) && nearest != up && along < 0.5 * whole)
        found_up_ = nearest;
    std::vector<double> heights;
    for (const auto* file : files) heights.push_back(file->stance.extent[axis_of(found_up_.value_or(up))]);
    height_ = median(heights);
}

std::string Doubts::height_remark(double scale, bool found) const {
    if (!(height_ > 0)) return {};
    const double metres = scale * height_;
    if (found) return fmt::format("scale {:.4g}: a body is about {} tall", scale, length(metres));
    if (metres >= smallest_body && metres <= largest_body) return {};
    const double fitting = fitting_scale(height_);
    return fmt::format(
        "a body is about {} tall at {:.4g} metres a unit; --scale {:.4g} would make it {}, and --scale auto "
        "finds that",
        length(metres), scale, fitting, length(fitting * height_));
}

std::string Doubts::size_remark() const {
    std::vector<std::string> others;
    for (const auto* file : files_)
        if (file->stance.size > 0 && size_ > 0 &&
            std::abs(std::log(file->stance.size / size_)) > std::log(other_unit))
            others.push_back(file->name);
    if (others.empty()) return {};
    return fmt::format(
        "{} of bodies more than {} times as large or as small as most ({}): in other units? They need an "
        "ingest of their "
        "own, with their --scale",
        files_of(others.size(), files_.size()), other_unit, first_few(others));
}

std::string Doubts::up_remark() const {
    if (!found_up_) return {};
    std::vector<std::string> names;
    for (const auto* file : files_)
        if (file->stance.upright && nearest_up(*file->stance.upright) == *found_up_)
            names.push_back(file->name);
    const bool on_head = axis_of(*found_up_) == axis_of(up_);
    return fmt::format(
        "bodies {}: from the root to the head they point along {} in {} ({}); --up {} turns them",
        on_head ? "stand on their heads" : "lie on their sides", name_of(*found_up_),
        files_of(names.size(), files_.size()), first_few(names), name_of(*found_up_));
}

std::vector<std::string> Doubts::remarks(double scale, bool found) const {
    std::vector<std::string> out;
    for (auto remark : {height_remark(scale, found), size_remark(), up_remark()})
        if (!remark.empty()) out.push_back(std::move(remark));
    return out;
}

}  // namespace actformer::ingest
