#include "eval/metrics/motion_measures.hpp"

#include <algorithm>
#include <cmath>

#include "base/text/lower_case.hpp"

namespace actformer::eval {
namespace {

using Point = std::array<double, 3>;

Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double length(const Point& a) {
    return std::hypot(a[0], a[1], a[2]);
}

/// Joint positions of one motion.
class Positions {
  public:
    Positions(std::span<const float> values, std::size_t persons, std::size_t joints)
        : values_(values), persons_(persons), joints_(joints) {}

    Point at(std::size_t frame, std::size_t person, std::size_t joint) const {
        const auto* v = &values_[((frame * persons_ + person) * joints_ + joint) * 3];
        return {v[0], v[1], v[2]};
    }

  private:
    std::span<const float> values_;
    std::size_t persons_, joints_;
};

/// Length of the second difference of what `of(frame)` says, around a frame.
template <typename Of>
double acceleration(std::size_t frame, const Of& of) {
    const auto before = minus(of(frame), of(frame - 1)), after = minus(of(frame + 1), of(frame));
    return length(minus(after, before));
}

struct Mean {
    double sum = 0;
    std::size_t count = 0;

    void add(double value) {
        sum += value;
        ++count;
    }
    double value() const { return count ? sum / static_cast<double>(count) : 0; }
};

double sliding(const Positions& positions, std::size_t frames, std::size_t persons,
               const MeasuredBody& body) {
    Mean speed;
    for (std::size_t p = 0; p < persons; ++p) {
        double floor = INFINITY;
        const auto height = [&](std::size_t t, std::size_t foot) {
            return body.up_sign * positions.at(t, p, foot)[body.up];
        };
        for (std::size_t t = 0; t < frames; ++t)
            for (const auto foot : body.feet) floor = std::min(floor, height(t, foot));
        for (std::size_t t = 0; t + 1 < frames; ++t)
            for (const auto foot : body.feet) {
                if (std::max(height(t, foot), height(t + 1, foot)) > floor + near_floor) continue;
                auto step = minus(positions.at(t + 1, p, foot), positions.at(t, p, foot));
                step[body.up] = 0;
                speed.add(length(step) * body.fps);
            }
    }
    return speed.value();
}

/// Over the steps between frames and the persons.
double root_speed(const Positions& positions, std::size_t frames, std::size_t persons, std::size_t root,
                  double fps) {
    Mean speed;
    for (std::size_t p = 0; p < persons; ++p)
        for (std::size_t t = 0; t + 1 < frames; ++t)
            speed.add(fps * length(minus(positions.at(t + 1, p, root), positions.at(t, p, root))));
    return speed.value();
}

std::vector<float> gathered(const std::vector<float>& from, std::span<const std::size_t> which,
                            std::size_t columns) {
    std::vector<float> out;
    if (from.empty()) return out;
    for (const auto i : which) {
        const auto first = from.begin() + static_cast<std::ptrdiff_t>(i * columns);
        out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(columns));
    }
    return out;
}

std::optional<double> mean_of(const std::vector<float>& values, std::span<const std::size_t> which) {
    if (values.empty() || which.empty()) return {};
    double sum = 0;
    for (const auto i : which) sum += values[i];
    return sum / static_cast<double>(which.size());
}

std::optional<double> ratio(std::optional<double> value, std::optional<double> to) {
    if (!value || !to || *to <= 0) return {};
    return *value / *to;
}

}  // namespace

std::vector<std::size_t> feet_among(std::span<const std::string> names) {
    const auto called = [&](std::initializer_list<const char*> words) {
        std::vector<std::size_t> found;
        for (std::size_t j = 0; j < names.size(); ++j) {
            const auto name = lower_case(names[j]);
            if (std::ranges::any_of(words, [&](const char* word) { return name.find(word) != name.npos; }))
                found.push_back(j);
        }
        return found;
    };
    const auto feet = called({"foot", "toe"});
    return feet.empty() ? called({"ankle"}) : feet;
}

void measure(std::span<const float> positions, std::size_t frames, std::size_t persons,
             const MeasuredBody& body, MotionMeasures& to) {
    const Positions at(positions, persons, body.parents.size());
    const double per_second = body.fps * body.fps;
    Mean limbs, roots;
    for (std::size_t t = 1; t + 1 < frames; ++t)
        for (std::size_t p = 0; p < persons; ++p)
            for (std::size_t j = 0; j < body.parents.size(); ++j) {
                const int parent = body.parents[j];
                if (parent < 0)
                    roots.add(per_second * acceleration(t, [&](auto f) { return at.at(f, p, j); }));
                else
                    limbs.add(per_second * acceleration(t, [&](auto f) {
                                  return minus(at.at(f, p, j), at.at(f, p, static_cast<std::size_t>(parent)));
                              }));
            }
    to.limb_acceleration.push_back(static_cast<float>(limbs.value()));
    to.root_acceleration.push_back(static_cast<float>(roots.value()));
    const auto root = static_cast<std::size_t>(std::ranges::find(body.parents, -1) - body.parents.begin());
    to.root_speed.push_back(static_cast<float>(root_speed(at, frames, persons, root, body.fps)));
    if (!body.feet.empty()) to.foot_sliding.push_back(static_cast<float>(sliding(at, frames, persons, body)));
    to.columns = persons * (persons - 1) / 2 * distance_frames;
    for (std::size_t i = 0; i < distance_frames; ++i) {
        const auto t = i * (frames - 1) / (distance_frames - 1);
        for (std::size_t p = 0; p < persons; ++p)
            for (std::size_t q = p + 1; q < persons; ++q)
                to.distances.push_back(
                    static_cast<float>(length(minus(at.at(t, p, root), at.at(t, q, root)))));
    }
}

MotionMeasures subset(const MotionMeasures& from, const std::vector<std::size_t>& which) {
    return {gathered(from.limb_acceleration, which, 1),    gathered(from.root_acceleration, which, 1),
            gathered(from.root_speed, which, 1),           gathered(from.foot_sliding, which, 1),
            gathered(from.distances, which, from.columns), from.columns};
}

MotionScore compare(const MotionMeasures& real, std::span<const std::size_t> of_real,
                    const MotionMeasures& generated, std::span<const std::size_t> of_generated) {
    MotionScore out;
    if (of_real.empty() || of_generated.empty()) return out;
    out.limb_acceleration =
        ratio(mean_of(generated.limb_acceleration, of_generated), mean_of(real.limb_acceleration, of_real));
    out.root_acceleration =
        ratio(mean_of(generated.root_acceleration, of_generated), mean_of(real.root_acceleration, of_real));
    out.root_speed = ratio(mean_of(generated.root_speed, of_generated), mean_of(real.root_speed, of_real));
    out.foot_sliding = mean_of(generated.foot_sliding, of_generated);
    if (real.columns > 0 && generated.columns > 0)
        out.root_distance = wasserstein(gathered(real.distances, of_real, real.columns),
                                        gathered(generated.distances, of_generated, generated.columns));
    return out;
}

double wasserstein(std::vector<float> a, std::vector<float> b) {
    std::ranges::sort(a);
    std::ranges::sort(b);
    double area = 0, at = std::min(a[0], b[0]);
    std::size_t i = 0, j = 0;
    while (i < a.size() || j < b.size()) {
        const double next = j == b.size() || (i < a.size() && a[i] <= b[j]) ? a[i] : b[j];
        area += (next - at) * std::abs(static_cast<double>(i) / static_cast<double>(a.size()) -
                                       static_cast<double>(j) / static_cast<double>(b.size()));
        at = next;
        while (i < a.size() && a[i] <= next) ++i;
        while (j < b.size() && b[j] <= next) ++j;
    }
    return area;
}

}  // namespace actformer::eval
