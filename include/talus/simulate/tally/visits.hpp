#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <unordered_map>
#include <vector>

#include "talus/physics/path.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/simulate/tally/quantities.hpp"
#include "talus/simulate/tally/source_reach.hpp"

namespace talus {

/// One way of a trajectory through a cell, with the largest values on it. A trajectory that comes back has several
/// visits to the cell; scoring joins them.
struct Visit : Maxima {
  std::uint16_t cell = 0;        ///< within its region: row * kRegionSide + column
  std::uint16_t trajectory = 0;  ///< within its batch
  std::uint32_t impacts : 22 = 0;
  std::uint32_t above : 6 = 0;      ///< energy thresholds that its whole length is above; the others nothing of it
  std::uint32_t mixed : 1 = 0;      ///< some threshold has a part of the length: see RegionVisits
  std::uint32_t deposited : 1 = 0;  ///< the path ends here: the block stays
  std::uint32_t trapped : 1 = 0;    ///< it stays because it is trapped
  std::uint32_t left : 1 = 0;       ///< the path leaves the terrain from here
  float length = 0.0F;              ///< counted, in plan [m]; if mixed, the bits are its index in RegionVisits::lengths
};

inline constexpr double kAnyHeight = std::numeric_limits<double>::infinity();

/// Which parts of a path count in the lengths of a cell.
struct LengthRules {
  std::vector<double> energies{};  ///< thresholds of the energy [kJ], ascending
  double below = kAnyHeight;       ///< only where the clearance is smaller [m]
  bool with_rotation = false;      ///< of the energy with rotation; else of the translational one

  std::size_t levels() const { return 1 + energies.size(); }  ///< all counted parts, then those above each threshold
};
LengthRules length_rules(const OutputSettings& output);

struct Moment;

/// Visits in the order in which they came, in pieces of memory of one size, which lists take from and give back to a
/// common store. So no visit is moved when a list grows; vectors would leave holes of all sizes between the records of
/// the tally.
class VisitList {
 public:
  using Piece = std::unique_ptr<Visit[]>;
  static constexpr std::size_t kPiece = 64;  // visits

  /// Makes the visit in its place: a copy would wait until what it reads is written.
  /// @param spare  pieces that no list uses; if there is none, one is made
  Visit& append(std::uint16_t cell, std::uint16_t trajectory, std::vector<Piece>& spare) {
    if (empty() || used_ == kPiece) append_piece(spare);
    return *::new (&pieces_.back()[used_++]) Visit{{}, cell, trajectory};
  }
  /// Gives all pieces back.
  void clear(std::vector<Piece>& spare);

  std::size_t size() const { return empty() ? 0 : (pieces_.size() - 1) * kPiece + used_; }
  bool empty() const { return pieces_.empty(); }
  std::size_t room() const { return pieces_.size() * kPiece; }  ///< visits that its memory holds
  /// Calls action(visit) for all visits. Prefetches the piece after the current one: they are scattered.
  template <class Action>
  void for_each(const Action& action) const {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const bool last = i + 1 == pieces_.size();
      for (std::size_t at = 0; !last && at < kPiece * sizeof(Visit); at += 64)
        __builtin_prefetch(reinterpret_cast<const char*>(pieces_[i + 1].get()) + at);
      for (const Visit& visit : std::span(pieces_[i].get(), last ? used_ : kPiece)) action(visit);
    }
  }

 private:
  void append_piece(std::vector<Piece>& spare);

  std::vector<Piece> pieces_;
  std::size_t used_ = 0;  // of the last piece, if there is one
};

/// The visits of a batch to one region of the grid.
struct RegionVisits {
  VisitList visits;
  std::vector<float> lengths;  ///< of mixed visits: all counted parts, then those above each threshold [m]
  std::vector<float> totals;   ///< largest `total` of each visit [m^2/s^2]; empty if it is not kept
};

/// Mass and diameter of a block; a diameter is needed for hazard only.
struct BlockSize {
  BlockSize(double of_mass) : mass(of_mass) {}                                   // NOLINT: a mass is enough
  BlockSize(const Block& block) : mass(block.mass), diameter(block.diameter) {}  // NOLINT
  double mass;                                                                   ///< [kg]
  double diameter = 0.0;                                                         ///< [m]
};

/// The visits of a batch of trajectories, collected by region of the grid: the tally is written region by region and
/// cell by cell, not along each path.
class VisitBatch {
 public:
  struct Trajectory {
    BlockSize size;
    std::uint32_t source;
    std::shared_ptr<SourceReach> reach;  // of a source cell that several batches share; else empty
    bool piece = false;                  // counts as one with the trajectory before it
    AnnualShare annual_share{};          // if the run has frequencies
  };

  explicit VisitBatch(const Grid& grid, LengthRules lengths = {});

  /// Reads a path. Within a cell the largest speed and clearance are exact, not sampled: both are closed forms on each
  /// patch (the speed is largest at an end, the clearance at an end or at the apex). So are the lengths: a span is cut
  /// at the borders of the cells, and where the energy or the clearance crosses its limit.
  /// The rest of a block that broke, and a path with `piece`, count as one with the trajectory before them.
  void add(const Path& path, BlockSize size, std::uint32_t source, std::shared_ptr<SourceReach> reach,
           bool piece = false);

  /// Keeps the largest energy with rotation of each visit, too; call it before the first path.
  void keep_energy_total() { keep_total_ = true; }

  /// Sets the annual share of the trajectories that are added from here on.
  void set_annual_share(const AnnualShare& annual_share) { annual_share_ = annual_share; }

  bool full() const { return size_ * sizeof(Visit) >= kBytes || trajectories_.size() >= kTrajectories; }
  void clear();

  const std::vector<Trajectory>& trajectories() const { return trajectories_; }
  const std::unordered_map<std::size_t, RegionVisits>& regions() const { return regions_; }
  std::size_t levels() const { return lengths_.levels(); }
  bool keeps_energy_total() const { return keep_total_; }
  bool counts_rotation() const { return lengths_.with_rotation; }
  bool has_pieces() const { return pieces_; }

 private:
  static constexpr std::size_t kBytes = 14U << 20U;  // of visits
  static constexpr std::size_t kTrajectories = 60'000;

  Visit& visit(int column, int row) { return column == column_ && row == row_ ? *visit_ : new_visit(column, row); }
  Visit& new_visit(int column, int row);
  void begin(Trajectory trajectory);
  void set_limits(double rotation);
  void add(const Path& path, std::size_t from, std::size_t to);
  void add(std::span<const Span> spans);
  void raise_total(const Span& span, const Moment& from, const Moment& to);
  void add_impacts(std::uint32_t impacts);
  float plan_length(const Span& span) const;
  void lengthen(const Span& span, float length, const Moment& from, const Moment& to);
  std::size_t level_of(const Span& span) const;
  void close_visit();
  float counted_share(const Span& span, float limit, const Moment& from, const Moment& to) const;

  Grid grid_;
  LengthRules lengths_;
  std::vector<float> limits_;  // square of the speed at each energy threshold, for this mass and rotation [m^2/s^2]
  std::vector<float> here_;    // lengths of the current visit by the number of thresholds that they are above [m]
  Regions layout_;
  std::unordered_map<std::size_t, RegionVisits> regions_;
  std::vector<VisitList::Piece> spare_;
  std::vector<Trajectory> trajectories_;
  AnnualShare annual_share_;
  std::size_t size_ = 0;  // memory of the lists, in visits: whole pieces
  bool pieces_ = false;
  bool keep_total_ = false;
  float rotation_ = 0.0F;       // twice the energy of the current rotation per mass [m^2/s^2]
  int column_ = -1, row_ = -1;  // cell of the current visit
  RegionVisits* region_ = nullptr;
  Visit* visit_ = nullptr;  // the current one, the last of its region
  std::size_t region_index_ = 0;
};

}  // namespace talus
