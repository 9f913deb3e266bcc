#include "ingest/synth/performer/play.hpp"

#include <algorithm>
#include <cmath>

#include "ingest/synth/performer/footsteps.hpp"

namespace actformer::ingest::synth {
namespace {

constexpr double fps = 30;

/// What both persons of a performance share.
struct Manner {
    double amplitude, tempo, phase, warp, begin, end, distance;
    bool mirrored;
    double facing, x, z;  ///< how the scene is turned and where it stands
    std::size_t frames;
};

Manner manner_of(const Programme& programme, const Casting& casting) {
    auto random = casting.stream(1);
    Manner m;
    m.amplitude = std::clamp(1 + 0.12 * random.normal(), 0.75, 1.3);
    m.tempo = std::clamp(std::exp(0.16 * random.normal()), 0.7, 1.5);
    m.phase = random.uniform();
    m.warp = 0.035 * random.normal();
    m.begin = random.uniform(-0.10, 0.06);
    m.end = random.uniform(0.93, 1.08);
    m.distance = 1 + 0.03 * random.normal();
    m.mirrored = random.chance(programme.persons == 2 ? 0.2 : 0.3);

    // One person mostly faces the middle camera; two are seen from the side, either of them on the left.
    m.facing = 180 + std::clamp(17 * random.normal(), -45.0, 45.0);
    if (programme.persons == 2) m.facing += random.chance(0.5) ? 90 : -90;
    m.x = 0.12 * random.normal();
    m.z = 0.12 * random.normal();
    const double seconds = programme.seconds * m.tempo * (m.end - m.begin);
    m.frames = static_cast<std::size_t>(std::clamp(std::lround(seconds * fps), 40L, 180L));
    return m;
}

/// How one performer moves, in general and this time.
struct Actor {
    Body body;
    Bearing bearing;
    double amplitude, phase;
    std::array<std::vector<Vec>, 2> off_target;  ///< a hand key each: nobody hits the same spot twice
};

Actor actor_of(const Programme& programme, int person, const Manner& manner, const Casting& casting) {
    const auto& performer = casting.cast.at(static_cast<std::size_t>(person));
    Random habits{0x4AB175, performer.habits};
    auto random = casting.stream(10 + static_cast<std::uint64_t>(person));
    Actor a;
    a.body = performer.body;
    auto& b = a.bearing;
    b.stance =
        std::clamp(0.095 + 0.02 * habits.normal() + 0.015 * random.normal(), 0.06, 0.17) * a.body.scale();
    b.toe_out = 9 + 4 * habits.normal();
    b.slouch = 3 + 2.5 * habits.normal() + random.normal();
    b.chin = 2 + 3 * habits.normal() + 1.5 * random.normal();
    b.arms_out = 0.075 + 0.02 * habits.normal() + 0.008 * random.normal();
    b.elbow_bend =
        std::clamp(a.body.hanging + 0.015 * habits.normal(), a.body.hanging - 0.05, a.body.hanging + 0.03);
    a.amplitude = manner.amplitude * (1 + 0.05 * habits.normal());
    a.phase = programme.persons == 2 ? 0 : manner.phase;  // the two keep time with each other
    for (int s = 0; s < 2; ++s)
        for (std::size_t k = 0; k < programme.parts[person].hands[s].size(); ++k)
            a.off_target[s].push_back(Vec{random.normal(), random.normal(), random.normal()} * 0.013);
    return a;
}

/// Goals that both persons must find stay exact.
bool exact(At at) {
    return at >= At::meet;
}

Vec off_target(const Actor& actor, const Part& part, const HandGoal& goal, int s) {
    const auto& keys = part.hands[s];
    const auto of = [&](const HandKey* key) {
        const bool listed = !keys.empty() && key >= keys.data() && key < keys.data() + keys.size();
        return listed && !exact(key->at) ? actor.off_target[s][static_cast<std::size_t>(key - keys.data())]
                                         : Vec{};
    };
    return lerp(of(goal.from), of(goal.to), goal.weight);
}

/// The action's own time of every frame: warped a little, and cut anywhere near its ends.
std::vector<double> timeline(const Manner& m) {
    std::vector<double> out;
    for (std::size_t f = 0; f < m.frames; ++f) {
        const double u =
            m.begin + (m.end - m.begin) * static_cast<double>(f) / static_cast<double>(m.frames - 1);
        out.push_back(u > 0 && u < 1 ? u + m.warp * std::sin(2 * pi * u) : u);
    }
    return out;
}

/// Balance and breath: slow, small, never still.
class Sway {
  public:
    explicit Sway(Random random)
        : random_(random), breath_(random_.uniform()), rate_(random_.uniform(0.2, 0.32)) {
        for (auto& w : wander_) w.start(random_);
    }

    void apply(Posture& p, double seconds, std::array<Vec, 2>& hands) {
        std::array<double, count> n;
        for (int i = 0; i < count; ++i) n[i] = smooth_[i] += 0.12 * (wander_[i].next(random_) - smooth_[i]);
        const double breath = std::sin(2 * pi * (breath_ + rate_ * seconds));
        p.c[px] += 0.008 * n[0];
        p.c[pz] += 0.008 * n[1];
        p.c[bend] += 1.2 * n[2] - 0.5 * breath;
        p.c[side] += 0.9 * n[3];
        p.c[twist] += 1.5 * n[4];
        p.c[nod] += 2.2 * n[5] + 0.3 * breath;
        p.c[turn] += 3.0 * n[6];
        p.c[tilt] += 1.2 * n[7];
        for (int s = 0; s < 2; ++s) {
            const int i = 8 + 3 * s;
            hands[s] += Vec{n[i], n[i + 1] + 0.2 * breath, n[i + 2]} * 0.012;
        }
    }

  private:
    static constexpr int count = 14;
    Random random_;
    double breath_, rate_;
    std::array<Wander, count> wander_ = make(std::make_index_sequence<count>{});
    std::array<double, count> smooth_{};

    template <std::size_t... i>
    static std::array<Wander, count> make(std::index_sequence<i...>) {
        return {((void)i, Wander(28))...};
    }
};

Place place_at(const Part& part, const Posture& posture, double size, double distance) {
    const auto& c = posture.c;
    const Vec start{part.x * size * distance, 0, part.z * size * distance};
    return {start + about_y(part.heading) * (Vec{c[wx], 0, c[wz]} * size), part.heading + c[wyaw]};
}

/// Adds the programme's own movements of the feet to their places.
void move_feet(std::array<Foot, 2>& feet, const Posture& posture, const Place& place, double size,
               double amplitude) {
    for (int s = 0; s < 2; ++s) {
        const Channel first = s == 0 ? lfx : rfx;
        const double o = s == 0 ? 1 : -1;
        const Vec moved{o * posture.c[first], posture.c[first + 1], posture.c[first + 2]};
        feet[s].place +=
            about_y(place.heading) * (moved * (size * (moved.y > 0.1 ? 0.6 + 0.4 * amplitude : 1.0)));
        feet[s].place.y += std::max(0.0, posture.c[lift]);
        feet[s].toes_down += posture.c[first + 3];
        feet[s].slack += 4 * std::max(0.0, moved.y);
    }
}

/// One person's whole part, all but the arms settled.
struct Played {
    Actor actor;
    std::vector<Posture> postures;
    std::vector<Place> places;
    Gait gait;
    std::vector<double> sink;
    std::vector<std::array<Vec, 2>> off_target;  ///< of the hands
};

/// The pelvis sinks ahead of need and rises after it, without a jerk: the largest need nearby, then averaged.
std::vector<double> settled(const std::vector<double>& need) {
    const int n = static_cast<int>(need.size());
    const auto at = [&](const std::vector<double>& v, int f) {
        return v[static_cast<std::size_t>(std::clamp(f, 0, n - 1))];
    };
    std::vector<double> most(need.size()), out(need.size());
    for (int f = 0; f < n; ++f)
        for (int d = -3; d <= 3; ++d) most[f] = std::max(most[f], at(need, f + d));
    for (int f = 0; f < n; ++f)
        for (int d = -3; d <= 3; ++d) out[f] += at(most, f + d) * (4 - std::abs(d)) / 16;
    return out;
}

Played played_by(const Programme& programme, int person, const Manner& m, const Casting& casting,
                 const std::vector<double>& times, double size) {
    Played out{actor_of(programme, person, m, casting), {}, {}, {}, {}, {}};
    const auto& part = programme.parts[person];
    const auto& [body, bearing, amplitude, phase, keys] = out.actor;
    Sway sway(casting.stream(20 + static_cast<std::uint64_t>(person)));
    for (std::size_t f = 0; f < times.size(); ++f) {
        out.postures.push_back(posture_at(programme, person, times[f], amplitude, m.tempo, phase));
        out.places.push_back(place_at(part, out.postures[f], size, m.distance));
        sway.apply(out.postures[f], static_cast<double>(f) / fps, out.off_target.emplace_back());
    }
    out.gait = walk(out.places, bearing, body.leg(), programme.cadence);
    std::vector<double> need;
    for (std::size_t f = 0; f < times.size(); ++f) {
        auto& posture = out.postures[f];
        posture.c[twist] += 7 * out.gait.swing[f];
        posture.c[yaw] -= 4 * out.gait.swing[f];
        move_feet(out.gait.feet[f], posture, out.places[f], body.scale(), amplitude);
        need.push_back(sink_needed(body, bearing, out.places[f], posture, out.gait.feet[f]));
    }
    out.sink = settled(need);
    return out;
}

/// Arms hanging at the side swing with the gait; busy ones do not.
Vec swing_of(const Played& p, std::size_t f, int s) {
    const auto& g = p.postures[f].hands[s];
    const double idle =
        lerp({g.from->at == At::rest ? 1.0 : 0.0, 0, 0}, {g.to->at == At::rest ? 1.0 : 0.0, 0, 0}, g.weight)
            .x;
    const double swing = (s == 1 ? 1 : -1) * p.gait.swing[f] * idle;
    return about_y(p.places[f].heading) * Vec{0, 0.05 * std::abs(swing), 0.20 * swing};
}

/// How far each hand goes from where the programme sends it.
std::array<Vec, 2> hand_shifts(const Played& p, const Part& part, std::size_t f) {
    auto shift = p.off_target[f];
    for (int s = 0; s < 2; ++s) {
        const auto& g = p.postures[f].hands[s];
        if (exact(g.to->at)) shift[s] = shift[s] * (1 - 0.8 * g.weight);
        shift[s] += off_target(p.actor, part, g, s) + swing_of(p, f, s);
    }
    return shift;
}

Others others_of(const std::array<Figure, 2>& figures, int person, int persons) {
    Others o;
    if (persons == 1) return o;
    o.partner = &figures[1 - person];
    const Vec a = figures[0].at[chest], b = figures[1].at[chest];
    o.meeting = lerp(a, b, 0.5);
    return o;
}

}  // namespace

Random Casting::stream(std::uint64_t purpose) const {
    auto numbers = key;
    numbers.push_back(purpose);
    return Random(numbers);
}

Play play(const Programme& programme, const Casting& casting) {
    const auto m = manner_of(programme, casting);
    const auto times = timeline(m);
    double size = 0;
    for (const auto& performer : casting.cast) size += performer.body.scale();
    size /= static_cast<double>(casting.cast.size());

    std::vector<Played> played;
    for (int p = 0; p < programme.persons; ++p)
        played.push_back(played_by(programme, p, m, casting, times, size));

    Play out{programme.persons, {}, -1, m.mirrored, m.facing, m.x, m.z};
    out.frames.resize(m.frames);
    std::array<Elbows, 2> elbows{};
    for (std::size_t f = 0; f < m.frames; ++f) {
        auto& figures = out.frames[f];
        for (int p = 0; p < out.persons; ++p) {
            const auto& q = played[p];
            figures[p] =
                stand(q.actor.body, q.actor.bearing, q.places[f], q.postures[f], q.gait.feet[f], q.sink[f]);
        }
        for (int p = 0; p < out.persons; ++p) {
            const auto& q = played[p];
            reach(figures[p], q.actor.body, q.actor.bearing, q.places[f], q.postures[f],
                  others_of(figures, p, out.persons), hand_shifts(q, programme.parts[p], f), elbows[p]);
        }
        if (programme.contact > 0 && out.contact < 0 && times[f] >= programme.contact)
            out.contact = static_cast<int>(f);
    }
    return out;
}

}  // namespace actformer::ingest::synth
