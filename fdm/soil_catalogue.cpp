#include "fdm/soil_catalogue.hpp"

#include <cmath>

namespace polder::fdm {
namespace {

constexpr double kPerCentimetre = 100;    // [1/m]
constexpr double kCentimetre = 0.01;      // [m]
constexpr double kPerDay = 0.01 / 86400;  // cm/d in m/s
constexpr double kPerHour = 0.01 / 3600;  // cm/h in m/s

// As tabulated: water contents, alpha [1/cm], n, conductivity [m/s].
CatalogueSoil van_genuchten(const char* name, const char* source, double residual, double saturated,
                            double alpha, double n, double conductivity) {
  Retention r;
  r.model = Retention::Model::van_genuchten;
  r.alpha = alpha * kPerCentimetre;
  r.n = n;
  r.residual = residual / saturated;
  return {name, source, r, saturated, conductivity};
}

// As tabulated, suction in cm: factors a [cm^b], A [cm^B].
CatalogueSoil haverkamp(const char* name, const char* source, double residual, double saturated, double a,
                        double b, double factor, double exponent, double conductivity) {
  Retention r;
  r.model = Retention::Model::haverkamp;
  r.residual = residual / saturated;
  r.haverkamp = {a * std::pow(kCentimetre, b), b, factor * std::pow(kCentimetre, exponent), exponent};
  return {name, source, r, saturated, conductivity};
}

std::vector<CatalogueSoil> build() {
  const char* carsel =
      "Carsel & Parrish (1988), Water Resour. Res. 24, 755-769: mean of the USDA textural class";
  const char* genuchten = "van Genuchten (1980), Soil Sci. Soc. Am. J. 44, 892-898, table 1";
  const char* celia = "Celia, Bouloutas & Zarba (1990), Water Resour. Res. 26, 1483-1496";
  const char* haverkamp77 = "Haverkamp et al. (1977), Soil Sci. Soc. Am. J. 41, 285-294";
  const char* vauclin = "Vauclin, Khanji & Vachaud (1979), Water Resour. Res. 15, 1089-1101";
  return {
      van_genuchten("sand", carsel, 0.045, 0.43, 0.145, 2.68, 712.8 * kPerDay),
      van_genuchten("loamy-sand", carsel, 0.057, 0.41, 0.124, 2.28, 350.2 * kPerDay),
      van_genuchten("sandy-loam", carsel, 0.065, 0.41, 0.075, 1.89, 106.1 * kPerDay),
      van_genuchten("loam", carsel, 0.078, 0.43, 0.036, 1.56, 24.96 * kPerDay),
      van_genuchten("silt", carsel, 0.034, 0.46, 0.016, 1.37, 6.00 * kPerDay),
      van_genuchten("silt-loam", carsel, 0.067, 0.45, 0.020, 1.41, 10.80 * kPerDay),
      van_genuchten("sandy-clay-loam", carsel, 0.100, 0.39, 0.059, 1.48, 31.44 * kPerDay),
      van_genuchten("clay-loam", carsel, 0.095, 0.41, 0.019, 1.31, 6.24 * kPerDay),
      van_genuchten("silty-clay-loam", carsel, 0.089, 0.43, 0.010, 1.23, 1.68 * kPerDay),
      van_genuchten("sandy-clay", carsel, 0.100, 0.38, 0.027, 1.23, 2.88 * kPerDay),
      van_genuchten("silty-clay", carsel, 0.070, 0.36, 0.005, 1.09, 0.48 * kPerDay),
      van_genuchten("clay", carsel, 0.068, 0.38, 0.008, 1.09, 4.80 * kPerDay),
      van_genuchten("hygiene-sandstone", genuchten, 0.153, 0.250, 0.0079, 10.4, 108.0 * kPerDay),
      van_genuchten("touchet-silt-loam", genuchten, 0.190, 0.469, 0.0050, 7.09, 303.0 * kPerDay),
      van_genuchten("silt-loam-ge3", genuchten, 0.131, 0.396, 0.00423, 2.06, 4.96 * kPerDay),
      van_genuchten("guelph-loam", genuchten, 0.218, 0.520, 0.0115, 2.03, 31.6 * kPerDay),
      van_genuchten("beit-netofa-clay", genuchten, 0.0, 0.446, 0.00152, 1.17, 0.082 * kPerDay),
      van_genuchten("new-mexico", celia, 0.102, 0.368, 0.0335, 2.0, 0.00922 * kCentimetre),
      haverkamp("haverkamp-sand", haverkamp77, 0.075, 0.287, 1.611e6, 3.96, 1.175e6, 4.74, 34 * kPerHour),
      haverkamp("vauclin-sand", vauclin, 0.0, 0.30, 4.0e4, 2.9, 2.99e6, 5.0, 35 * kPerHour),
  };
}

}  // namespace

const std::vector<CatalogueSoil>& soil_catalogue() {
  static const std::vector<CatalogueSoil> catalogue = build();
  return catalogue;
}

const CatalogueSoil* find_soil(std::string_view name) {
  for (const CatalogueSoil& s : soil_catalogue())
    if (s.name == name) return &s;
  return nullptr;
}

std::string soil_names() {
  std::string names;
  for (const CatalogueSoil& s : soil_catalogue()) names += (names.empty() ? "" : ", ") + s.name;
  return names;
}

}  // namespace polder::fdm
