#pragma once
#include "talus/fit/calibrate/fit_problem.hpp"

namespace talus {

/// The numbers of a fit to several campaigns.
struct JointParameters {
  std::vector<Parameter> free;                    ///< "authume: ground.zones.default.En50"; shared ones without a site
  std::vector<std::vector<SiteParameter>> sites;  ///< by site, in the order of its own parameters
};

/// Joins the parameters of several campaigns. Those that `share` names become one number for all sites that have it: a
/// parameter of the ground ("phi") in zones of the same name, a number of an effect by its key. Prior and bounds of a
/// shared number: the means of the centres and sds, the widest bounds.
///
/// @param names  of the sites
/// @param own    free parameters of each site
///
/// Throws InputError for a name that no two sites have in common.
JointParameters joint_parameters(std::span<const std::string> names, std::span<const std::vector<Parameter>> own,
                                 std::span<const std::string> share);

/// Adds the numbers of an effect, each of them one for all sites that have it.
///
/// @param effect  by site; empty where the site does not have the effect
JointParameters with_shared(JointParameters joint, std::span<const std::vector<Parameter>> effect);

/// Throws InputError for a name of `share` that is not among the fitted keys.
void check_shared(std::span<const std::string> share, std::span<const std::string> keys);

}  // namespace talus
