# What is served to browsers, beside what npm brings. FILE is served as /FILE.
set(page_files
  index.html
  icon.svg
  app.js
  core/api.js
  core/charts.js
  core/dialog.js
  core/dom.js
  core/download.js
  core/format.js
  core/live.js
  core/route.js
  core/theme.js
  core/uplot.js
  form/estimate.js
  form/field.js
  form/fields.js
  form/request.js
  pages/job.js
  pages/new_sweep.js
  pages/sweep.js
  pages/sweeps.js
  run/facts.js
  run/ideal.js
  run/labels.js
  run/orbit.js
  run/orbit_drawing.js
  run/overlay.js
  run/overview.js
  run/plot_card.js
  run/plot_data.js
  run/plot_options.js
  run/time_bar.js
  run/time_plot.js
  run/time_window.js
  scene/linkage.js
  scene/player.js
  scene/poses.js
  scene/scene_card.js
  scene/shapes.js
  scene/stage.js
  scene/three.js
  study/data.js
  study/heat_map.js
  study/lines.js
  study/parallel.js
  study/selection.js
  study/sweep_row.js
  study/table.js
  style/base.css
  style/pages.css
  style/parts.css
  style/plot.css)

# Of the packages: SERVED=FILE.
set(page_packages
  lib/echarts.js=echarts/dist/echarts.esm.min.js
  lib/orbit_controls.js=three/examples/jsm/controls/OrbitControls.js
  lib/three.core.js=three/build/three.core.js
  lib/three.module.js=three/build/three.module.js
  lib/uplot.css=uplot/dist/uPlot.min.css
  lib/uplot.js=uplot/dist/uPlot.esm.js)

# Browsers know no packages: a module that is imported by the NAME before "=" is taken from there.
set(page_imports three=/lib/three.module.js)
