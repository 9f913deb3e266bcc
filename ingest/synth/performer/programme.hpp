// What is done in an action: keyframes and oscillations of a few channels, for one person or two.
#pragma once

#include <array>
#include <vector>

#include "ingest/synth/geometry.hpp"

namespace actformer::ingest::synth {

/// Where a hand is sent. Offsets are metres on a body of 1.72 m: x outwards on the hand's own side, y up, z
/// forward, in the frame of the part named.
enum class At {
    rest,   ///< hanging at the side
    reach,  ///< offset from the own shoulder, upright, in lengths of the arm
    chest,  ///< in front of the breastbone
    belly,
    low_back,
    shoulder,  ///< the other one
    elbow,     ///< beside the other upper arm
    throat,
    nape,
    mouth,
    nose,
    brow,
    eye,
    ear,
    crown,
    pocket,
    back_pocket,
    waist,
    thigh,
    knee,
    foot,
    other_foot,
    floor,  ///< before the feet
    meet,   ///< midway between two persons at the height of the chests: x to the first one's left, z to the
            ///< second
    partner_head,
    partner_ear,
    partner_chest,
    partner_belly,
    partner_back,
    partner_nape,
    partner_shoulder,  ///< the one opposite the hand
    partner_pocket
};

/// Angles in degrees, offsets in metres.
enum Channel : int {
    px,
    py,
    pz,  ///< pelvis against the feet: left, up, forward
    yaw,
    pitch,
    roll,  ///< pelvis: to the left, forward, to the right
    bend,
    side,
    twist,  ///< spine: forward, to the right, to the left
    nod,
    turn,
    tilt,  ///< head: down, to the left, to the right
    lift,  ///< the whole body off the floor
    wx,
    wz,
    wyaw,  ///< place and heading, reached in steps
    lx,
    ly,
    lz,
    rx,
    ry,
    rz,  ///< hands: added outwards, up, forward
    lelbow,
    relbow,  ///< elbows raised outwards
    lgrip,
    rgrip,
    lroll,
    rroll,
    lflex,
    rflex,  ///< fingers 0 straight 1 fist, thumb about the forearm, wrist to the palm
    lfx,
    lfy,
    lfz,
    lfp,
    rfx,
    rfy,
    rfz,
    rfp,  ///< feet against their place: outwards, up, forward, toes down
    channels
};

/// Times are fractions of the action.
struct Key {
    double t, value;
};

struct HandKey {
    double t;
    At at;
    double x = 0, y = 0, z = 0;
};

struct Track {
    Channel channel;
    std::vector<Key> keys;
};

struct Wave {
    Channel channel;
    double amplitude, hertz, from, to, phase;  ///< phase in turns
    bool half;                                 ///< only the upper half of the sine
};

struct Part {
    std::array<std::vector<HandKey>, 2> hands;  ///< left, right
    std::vector<Track> tracks;
    std::vector<Wave> waves;
    double x = 0, z = 0, heading = 0;  ///< where the person starts on the stage
};

/// One action. Methods add to the person chosen last: the first one, until `other()`, and after `first()` again.
class Programme {
  public:
    Programme(int number, double duration) : action(number), seconds(duration) {}

    Programme& left(const std::vector<HandKey>& keys);
    Programme& right(const std::vector<HandKey>& keys);
    Programme& both(const std::vector<HandKey>& keys);
    Programme& move(Channel channel, const std::vector<Key>& keys);
    Programme& hold(Channel channel, double value) { return move(channel, {{0, value}}); }
    Programme& wave(Channel channel, double amplitude, double hertz, double from, double to,
                    double phase = 0);
    Programme& beat(Channel channel, double amplitude, double hertz, double from, double to,
                    double phase = 0);
    Programme& fists(double left_grip, double right_grip);
    Programme& seated();
    Programme& fall(double from, double to);
    Programme& stand(double x, double z, double heading);
    Programme& facing(double distance);
    Programme& other();
    Programme& first();

    int action;  ///< a number of the table it stands in
    double seconds;
    int persons = 1;
    double contact = 0;    ///< when two persons touch, 0 where they do not
    double cadence = 2.4;  ///< the most steps a second
    std::array<Part, 2> parts;

    Programme& touch_at(double t);
    Programme& steps_a_second(double most);

  private:
    int current_ = 0;
};

/// `keys` played `n` times between `from` and `to`.
std::vector<HandKey> cycles(int n, double from, double to, const std::vector<HandKey>& keys);

/// Channels and hands of one person at time `t`, and how far a hand is between two keys.
struct HandGoal {
    const HandKey* from;
    const HandKey* to;
    double weight;
};
struct Posture {
    std::array<double, channels> c{};
    std::array<HandGoal, 2> hands;
};

/// `amplitude` and `tempo` stretch oscillations, `phase` (turns) shifts those of one body's own rhythm.
Posture posture_at(const Programme& programme, int person, double t, double amplitude, double tempo,
                   double phase);

}  // namespace actformer::ingest::synth
