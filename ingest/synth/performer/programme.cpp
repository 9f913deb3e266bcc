#include "ingest/synth/performer/programme.hpp"

#include <algorithm>

namespace actformer::ingest::synth {
namespace {

void append(std::vector<HandKey>& to, const std::vector<HandKey>& keys) {
    to.insert(to.end(), keys.begin(), keys.end());
}

double value_at(const std::vector<Key>& keys, double t) {
    const auto next = std::find_if(keys.begin(), keys.end(), [t](const Key& k) { return k.t > t; });
    if (next == keys.end()) return keys.back().value;
    if (next == keys.begin() && next->t <= 0) return next->value;  // what is so from the start
    const Key before = next == keys.begin() ? Key{0, 0} : *(next - 1);
    return before.value + (next->value - before.value) * ease((t - before.t) / (next->t - before.t));
}

HandGoal goal_at(const std::vector<HandKey>& keys, double t) {
    static const HandKey hanging{0, At::rest};
    const auto next = std::find_if(keys.begin(), keys.end(), [t](const HandKey& k) { return k.t > t; });
    if (next == keys.end()) {
        const HandKey* last = keys.empty() ? &hanging : &keys.back();
        return {last, last, 1};
    }
    if (next == keys.begin() && next->t <= 0) return {&*next, &*next, 1};
    const HandKey* before = next == keys.begin() ? &hanging : &*(next - 1);
    return {before, &*next, ease((t - before->t) / (next->t - before->t))};
}

/// Oscillations swell and die over a fifth of a second's worth of their span.
double wave_at(const Wave& w, double t, double seconds, double phase) {
    if (t <= w.from || t >= w.to) return 0;
    const double fade = std::min(0.25 / seconds, (w.to - w.from) / 3);
    const double envelope = ease(std::min(t - w.from, w.to - t) / fade);
    const double s = std::sin(2 * pi * (w.hertz * (t - w.from) * seconds + w.phase + phase));
    return w.amplitude * envelope * (w.half ? std::max(0.0, s) : s);
}

}  // namespace

Programme& Programme::left(const std::vector<HandKey>& keys) {
    append(parts[current_].hands[0], keys);
    return *this;
}

Programme& Programme::right(const std::vector<HandKey>& keys) {
    append(parts[current_].hands[1], keys);
    return *this;
}

Programme& Programme::both(const std::vector<HandKey>& keys) {
    return left(keys).right(keys);
}

Programme& Programme::move(Channel channel, const std::vector<Key>& keys) {
    auto& tracks = parts[current_].tracks;
    const auto found =
        std::find_if(tracks.begin(), tracks.end(), [=](const Track& t) { return t.channel == channel; });
    if (found == tracks.end())
        tracks.push_back({channel, keys});
    else
        found->keys.insert(found->keys.end(), keys.begin(), keys.end());
    return *this;
}

Programme& Programme::wave(Channel channel, double amplitude, double hertz, double from, double to,
                           double phase) {
    parts[current_].waves.push_back({channel, amplitude, hertz, from, to, phase, false});
    return *this;
}

Programme& Programme::beat(Channel channel, double amplitude, double hertz, double from, double to,
                           double phase) {
    parts[current_].waves.push_back({channel, amplitude, hertz, from, to, phase, true});
    return *this;
}

Programme& Programme::fists(double left_grip, double right_grip) {
    return move(lgrip, {{0.15, left_grip}, {0.85, left_grip}, {1, 0.2}})
        .move(rgrip, {{0.15, right_grip}, {0.85, right_grip}, {1, 0.2}});
}

Programme& Programme::seated() {
    return hold(py, -0.41).hold(pz, -0.40).hold(bend, 6).both({{0, At::thigh}});
}

/// Backwards onto the seat and then the back.
Programme& Programme::fall(double from, double to) {
    const auto at = [=](double u) { return from + (to - from) * u; };
    return move(py, {{from, 0}, {at(0.25), -0.12}, {at(0.7), -0.74}, {to, -0.80}})
        .move(pz, {{from, 0}, {at(0.25), -0.06}, {at(0.7), -0.48}, {to, -0.52}})
        .move(pitch, {{from, 0}, {at(0.25), 8}, {at(0.7), -30}, {to, -74}})
        .move(bend, {{from, 0}, {at(0.5), 30}, {at(0.8), 25}, {to, 2}})
        .move(nod, {{from, 0}, {at(0.7), 25}, {to, 5}})
        .both({{from, At::rest},
               {at(0.3), At::reach, 0.4, -0.2, 0.5},
               {at(0.7), At::reach, 0.6, -0.75, -0.2},
               {to, At::reach, 0.65, -0.3, -0.62}});
}

Programme& Programme::stand(double x, double z, double heading) {
    parts[current_].x = x;
    parts[current_].z = z;
    parts[current_].heading = heading;
    return *this;
}

Programme& Programme::facing(double distance) {
    persons = 2;
    parts[0].z = -distance / 2;
    parts[1].z = distance / 2;
    parts[1].heading = 180;
    return *this;
}

Programme& Programme::other() {
    persons = 2;
    current_ = 1;
    return *this;
}

Programme& Programme::first() {
    current_ = 0;
    return *this;
}

Programme& Programme::touch_at(double t) {
    contact = t;
    return *this;
}

Programme& Programme::steps_a_second(double most) {
    cadence = most;
    return *this;
}

std::vector<HandKey> cycles(int n, double from, double to, const std::vector<HandKey>& keys) {
    std::vector<HandKey> out;
    for (int i = 0; i < n; ++i)
        for (auto key : keys) {
            key.t = from + (to - from) * (i + key.t) / n;
            out.push_back(key);
        }
    return out;
}

Posture posture_at(const Programme& programme, int person, double t, double amplitude, double tempo,
                   double phase) {
    const auto& part = programme.parts[person];
    Posture posture;
    for (const auto& track : part.tracks) posture.c[track.channel] = value_at(track.keys, t);
    for (int c = yaw; c <= tilt; ++c) posture.c[c] *= 0.5 + 0.5 * amplitude;
    for (const auto& w : part.waves)
        posture.c[w.channel] += amplitude * wave_at(w, t, programme.seconds * tempo, phase);
    for (int side_of = 0; side_of < 2; ++side_of) posture.hands[side_of] = goal_at(part.hands[side_of], t);
    return posture;
}

}  // namespace actformer::ingest::synth
