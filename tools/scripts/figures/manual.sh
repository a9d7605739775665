#!/usr/bin/env bash
# Draws the pictures of the manual into docs/pictures (or the folder given): runs the example valley and the job of
# docs/road-job.md, and draws each product over the hillshade. Two minutes. The program is TALUS, else talus of the path.
# The last pictures are drawn by QGIS; where QGIS is not installed a line says so and the rest is made.
set -euo pipefail
cd "$(dirname "$0")/../../.."
pictures=$(realpath "${1:-docs/pictures}")
talus=${TALUS:-talus}
figures=tools/scripts/figures
valley=data/valley
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cliffs=$valley/cliffs.shp lines=$valley/screens.gpkg houses=$valley/houses.gpkg

draw() {  # NAME RASTER options of picture.py
  local name=$1 raster=$2
  shift 2
  /usr/bin/python3 $figures/picture.py $valley/dem.tif ${raster:+"$raster"} -o "$pictures/$name.png" --width 6.4 --dpi 100 "$@"
}

"$talus" run $valley/scenario.toml -q -o "$work/valley"
"$talus" hazard "$work/valley" -q --width 10
"$talus" barrier "$work/valley" --screen road --gTr 1.02 --gDp 1.02 --gVol 1.02 -q
"$talus" sources --dem $valley/dem.tif -q -o "$work/candidates.gpkg"
ogr2ogr "$work/steep.gpkg" "$work/candidates.gpkg" source_polygons
"$talus" run --dem $valley/dem.tif --sources $cliffs --trajectories 20 -q -o "$work/first"
ogr2ogr "$work/ground.gpkg" $valley/zones.gpkg -dialect sqlite \
  -sql "SELECT geom, CASE zone WHEN 'road' THEN 'forest-road-3d' ELSE 'upper-talus-3d' END AS preset FROM zones"
"$talus" run --dem $valley/dem.tif --sources $cliffs --zones "$work/ground.gpkg" --zone-field preset --screens $lines \
  --count-rotation --trajectories 50 -q -o "$work/job"  # as docs/road-job.md
"$talus" hazard "$work/job" -q --width 10
"$talus" barrier "$work/job" --screen road -q
out=$work/valley

draw hillshade "" --title "DEM (hillshade), cliffs, lines, houses" --vectors $cliffs $lines $houses
draw candidates "" --title "Cells steeper than 49.6 degrees" --vectors $cliffs "$work/steep.gpkg"
draw first_map "$work/first/impact_probability.tif" --log --classes 0.00001,0.0001,0.001,0.01 --title "First map: impact probability" --vectors $cliffs
draw release "$out/release.tif" --title "Blocks released" --colours viridis --unit blocks --vectors $cliffs
draw valley "$out/impact_probability.tif" --log --classes 0.00001,0.0001,0.001,0.01 --title "Impact probability" --vectors $cliffs $lines $houses
draw reach "$out/reach_probability.tif" --log --classes 0.02,0.05,0.1,0.2,0.5 --title "Reach probability" --vectors $cliffs $lines
draw valley_energy "$out/energy.tif" --band 3 --classes 1,30,100,300,1000 --unit kJ --title "Translational energy, P95" --vectors $cliffs $lines
draw velocity "$out/velocity.tif" --band 3 --classes 1,5,10,15,20,25 --unit m/s --colours viridis --title "Speed, P95" --vectors $cliffs $lines
draw jump_height "$out/jump_height.tif" --band 3 --classes 0.1,0.5,1,2,4,8 --unit m --colours viridis --title "Jump height, P95" --vectors $cliffs $lines
draw valley_exceedance "$out/energy_exceedance.tif" --band 2 --classes 1e-5,1e-4,1e-3,1e-2,1e-1 --title "P(E with rotation > 300 kJ)" --vectors $cliffs $lines
draw passage_density "$out/passage_density.tif" --classes 1e-6,1e-5,1e-4,1e-3,1e-2 --unit 1/m --title "Passage density" --vectors $cliffs $lines
draw deposits "$out/deposits.tif" --classes 1,3,10,30,100 --unit blocks --colours viridis --title "Blocks that came to rest" --vectors $cliffs $lines $houses
draw trajectories "" --title "200 of the paths" --vectors "$out/trajectories.gpkg" $cliffs $lines
draw hazard_return_period "$out/return_period_30.tif" --classes 1,30,100,300,1000,10000 --unit years --colours PuBuGn_r --title "Return period of E with rotation > 30 kJ, object 10 m wide" --vectors $cliffs $lines $houses
draw hazard_class "$out/hazard_class.tif" --names none,residual,low,medium,high --title "Class of hazard, object 10 m wide" --vectors $cliffs $lines $houses
draw hazard_undecided "$out/hazard_class.tif" --band 4 --names decided,undecided --title "Class not decided by this number of blocks" --vectors $cliffs
/usr/bin/python3 $figures/barrier_picture.py "$out" --screen road -o "$pictures/valley_barrier.png" --bin 20
/usr/bin/python3 $figures/grounds_picture.py $valley/dem.tif "$pictures/grounds.png" --talus "$talus" --sources $cliffs --lines $lines
draw job_hazard "$work/job/hazard_class.tif" --names none,residual,low,medium,high --title "Class of hazard, object 10 m wide" --vectors $cliffs $lines $houses
/usr/bin/python3 $figures/barrier_picture.py "$work/job" --screen road -o "$pictures/job_barrier.png" --bin 20
if /usr/bin/python3 -c "import qgis.core" 2>/dev/null; then
  QT_QPA_PLATFORM=offscreen HOME=$work XDG_RUNTIME_DIR=$work /usr/bin/python3 $figures/qgis_picture.py $valley/dem.tif "$out/hazard_class.tif" "$pictures/qgis.png"
  TALUS=$talus QT_QPA_PLATFORM=offscreen HOME=$work XDG_RUNTIME_DIR=$work /usr/bin/python3 $figures/qgis_pictures.py "$pictures"
else
  echo "manual.sh: QGIS is not installed; qgis.png, qgis_run.png and qgis_results.png are not drawn" >&2
fi
for picture in "$pictures"/*.png; do
  [ "$(stat -c %s "$picture")" -le 120000 ] || echo "manual.sh: $picture is larger than 120 kB" >&2
done
