#pragma once
#include "talus/fit/calibrate/joint_parameters.hpp"
#include "talus/fit/campaign/sites.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"

namespace talus {

/// Models of several campaigns that were fitted together: the numbers of an effect are shared, the ground of each site
/// is its own.
struct JointModel {
  std::vector<Model> models;  ///< by site
  JointParameters parameters;
  Eigen::VectorXd z;
  std::vector<std::vector<BlockRuns>> runs;  ///< by site: of the fitting rows, with random numbers of their own
  Score score;                               ///< of all sites together
  Score objective;                           ///< the same with its groups weighed
  Eigen::MatrixXd spread;                    ///< as FittedModel::spread
  std::vector<Evaluation> evaluations;
};

/// An effect with the same numbers at all sites, fitted together with the ground of each. Its gains are of the
/// objective of all sites, their intervals over the blocks of all.
struct JointCandidate : FittedEffect {
  JointModel fitted;
};

/// One turn of the loop over the effects that sites may share.
struct JointRound {
  std::string effect = "none", where;
  FamilyTest family;                       ///< "block property" of all sites together
  std::vector<JointCandidate> candidates;  ///< best first; none where the family is not significant
  std::vector<std::string> alike;
};

/// What one campaign shows alone.
struct SiteDiagnosis {
  std::string name;
  FittedModel base;       ///< the ground alone: the same fit as in a diagnosis of this campaign
  TrialsPerBlock trials;  ///< of that fit and these tests
  std::vector<FamilyTest>
      families;  ///< Holm over those of all sites and the pooled one; "block property" takes no part
  std::vector<ResidualRow> residual = {};   ///< of the fitting rows, with the ground alone
  std::vector<DetectionLimit> limits = {};  ///< of effects at this site alone, with the ground alone
};

struct SitesDiagnosis {
  std::vector<SiteDiagnosis> sites;
  std::vector<JointRound> rounds;
  std::vector<Model> base;               ///< by site: the ground alone
  std::vector<Model> with_effects;       ///< by site; the base where nothing was found
  TrialsPerBlock trials;                 ///< of the fits together
  double p_value = 1.0;                  ///< the smallest corrected one of all families
  std::vector<NestedValidation> nested;  ///< by site, without candidates; empty: not asked for, or not possible
  std::string not_nested;                ///< why it was not possible, though asked for
};

/// Finds an effect that several campaigns share.
///
/// @param sites  two or more, ordered by their names, their streams their own (`give_own_streams`)
/// @param start  models of the sites
///
/// (1) Fits the ground of each site and tests its families, as `diagnose` does. (2) Tests the family "block property"
/// with the blocks of all sites together, an intercept for each site and group. (3) Where that is significant, fits its
/// effects with the same numbers at all sites and a ground of each, and chooses by the rules of `diagnose`. (4) Adds
/// the effect and tests again. (5) With `nested`, where every site has enough blocks, repeats all that once for each
/// number of a fold, without the folds of this number of all sites. docs/several-campaigns.md.
///
/// Throws FitInterrupted when `proceed` returns false.
SitesDiagnosis diagnose_sites(std::span<const Site> sites, std::span<const Model> start,
                              const DiagnoseOptions& options);

}  // namespace talus
