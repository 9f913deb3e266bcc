#include "ingest/synth/performer/footsteps.hpp"

#include <algorithm>
#include <cmath>

namespace actformer::ingest::synth {
namespace {

constexpr double margin = 0.4;  // of a step, during which both feet stand before the first and after the last

Foot standing(const Place& place, const Bearing& bearing, int s) {
    const double o = s == 0 ? 1 : -1;
    Foot foot;
    foot.place = place.position + about_y(place.heading) * Vec{o * bearing.stance, 0, 0};
    foot.heading = place.heading + o * bearing.toe_out;
    return foot;
}

/// A stretch of frames in which the body is under way, and its clock in steps: 0 at the first footfall.
struct Walk {
    std::size_t first, last;
    int steps;
    std::vector<double> clock;
};

/// Metres walked in each frame; turning counts, since it needs steps too.
std::vector<double> paces(const std::vector<Place>& places) {
    std::vector<double> out(places.size(), 0);
    for (std::size_t f = 1; f < places.size(); ++f)
        out[f] = length(places[f].position - places[f - 1].position) +
                 0.3 * radians(std::abs(places[f].heading - places[f - 1].heading));
    return out;
}

std::vector<Walk> walks(const std::vector<Place>& places, double stride, double cadence) {
    const auto pace = paces(places);
    constexpr double still = 0.002;
    std::vector<Walk> out;
    for (std::size_t f = 1; f < places.size(); ++f) {
        if (pace[f] < still) continue;
        Walk w{f - 1, f, 0, {0}};
        double total = 0;
        for (; f < places.size() && pace[f] >= still; ++f) w.clock.push_back(total += pace[f]);
        w.last = f - 1;
        const double seconds = static_cast<double>(w.last - w.first) / 30;
        const double wanted = std::clamp(total / stride, 0.0, seconds * cadence);
        w.steps = std::max(total > 0.12 ? 2 : 1, static_cast<int>(std::lround(wanted)));
        for (auto& c : w.clock) c = c / total * (w.steps + 2 * margin) - margin;
        if (total > 0.03) out.push_back(std::move(w));
    }
    return out;
}

/// The frame at which the clock shows `step`.
std::size_t frame_of(const Walk& w, double step) {
    const auto at = std::lower_bound(w.clock.begin(), w.clock.end(), step);
    return std::min(w.last, w.first + static_cast<std::size_t>(at - w.clock.begin()));
}

/// Foot `s` falls at every second step; before the first and after the last it stands under the body.
Foot fallen(const Walk& w, const std::vector<Place>& places, const Bearing& bearing, int s, int step) {
    if (step <= 0) return standing(places[w.first], bearing, s);
    if (step >= w.steps) return standing(places[w.last], bearing, s);
    return standing(places[frame_of(w, step)], bearing, s);
}

Foot stepping(const Walk& w, const std::vector<Place>& places, const Bearing& bearing, int s, double clock,
              double rise) {
    const int before = 2 * static_cast<int>(std::floor((clock - s) / 2)) + s;
    const double phase = std::clamp((clock - before - 0.6) / 0.8, 0.0, 1.0);  // of the swing
    const Foot a = fallen(w, places, bearing, s, before), b = fallen(w, places, bearing, s, before + 2);
    const double moved = length(b.place - a.place) + 0.3 * radians(std::abs(b.heading - a.heading));
    if (phase <= 0 || moved < 0.01) return a;
    if (phase >= 1) return b;
    Foot foot = a;
    const double u = ease(phase);
    foot.place = lerp(a.place, b.place, u);
    foot.place.y = rise * std::min(1.0, moved / 0.4 + 0.4) * std::pow(std::sin(pi * phase), 1.3);
    foot.heading = a.heading + (b.heading - a.heading) * u;
    const double push_off = 38 * std::sin(pi * std::min(1.0, phase * 1.7));
    const double heel_first = 14 * ease(phase * 2 - 0.9) * (1 - phase) * 4;
    foot.toes_down = std::min(1.0, moved / 0.5) * (push_off - heel_first);
    foot.slack = 0.3 * std::pow(std::sin(pi * phase), 2);
    return foot;
}

}  // namespace

Gait walk(const std::vector<Place>& places, const Bearing& bearing, double leg, double cadence) {
    Gait gait;
    gait.swing.assign(places.size(), 0);
    const auto all = walks(places, 0.58 * leg, cadence);
    auto next = all.begin();
    for (std::size_t f = 0; f < places.size(); ++f) {
        while (next != all.end() && f > next->last) ++next;
        std::array<Foot, 2> feet;
        if (next != all.end() && f >= next->first) {
            const double clock = next->clock[f - next->first];
            for (int s = 0; s < 2; ++s)
                feet[s] = stepping(*next, places, bearing, s, clock, 0.07 * leg / 0.8);
            const double here = std::min({1.0, clock + margin, next->steps + margin - clock});
            const double speed = f > 0 ? length(places[f].position - places[f - 1].position) * 30 : 0;
            gait.swing[f] = here * std::min(1.0, speed) * std::cos(pi * (clock + 0.5));
        } else {
            for (int s = 0; s < 2; ++s) feet[s] = standing(places[f], bearing, s);
        }
        gait.feet.push_back(feet);
    }
    return gait;
}

}  // namespace actformer::ingest::synth
