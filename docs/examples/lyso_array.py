# %% [markdown]
# # An 8 x 8 LYSO array: flood map, spectrum, depth curve and timing
#
# Crystals of 3.1 x 3.1 x 20 mm3 in ESR film, one light guide of 1 mm under them, 8 x 8 SiPMs, 511 keV gammas from
# above. The scene is built below in twenty lines; every key is described in docs/scene_files.md. The sensor's times
# and microcells are round numbers to begin with (assumed).
# %%
import scintray
# %%
scene = scintray.Scene("8 x 8 LYSO array on SiPMs", contacts_default="bonded")
scene.array("crystal", count=[8, 8], pitch="3.2 mm", element={
    "box": ["3.1 mm", "3.1 mm", "20 mm"], "medium": "LYSO", "surface": "wrapped",
    "face": [{"name": "exit", "select": {"normal": [0, 0, -1]}, "surface": "polished"}]})
scene.part("guide", box=["25.6 mm", "25.6 mm", "1 mm"], medium="glass", surface="polished",
           place={"touch": "crystal", "side": "-z", "gap": "0.1 mm", "fill": "optical_grease"})
scene.array("sipm", count=[8, 8], pitch="3.2 mm", element={"box": ["3 mm", "3 mm", "0.3 mm"], "sensor": "sipm"},
            place={"touch": "guide", "side": "-z", "gap": "0.1 mm", "fill": "optical_grease"})
scene.define("surfaces", "wrapped", base="polished", gap="air", reflector="ESR")
scene.define("sensors", "sipm", base="S13360_6050VE", transit_time={"fwhm": "150 ps"},
             single_electron={"charge_spread": "5 %", "rise": "0.5 ns", "decay": "20 ns"},
             microcells={"pitch": "0.05 mm", "recovery": "20 ns", "crosstalk": "5 %"})
scene["source"] = {"type": "gammas", "events": 200, "emission": "gamma", "energy": "511 keV", "direction": [0, 0, -1],
                   "plane": {"center": ["0 mm", "0 mm", "30 mm"], "x": ["25 mm", "0 mm", "0 mm"],
                             "y": ["0 mm", "25 mm", "0 mm"]}, "vacuum": ["sipm[*]"]}
scene["readout"] = {"sampling": "1 GHz", "before": "50 ns", "window": "300 ns", "threshold": 3.0}
scene["analysis"] = {"depth": {"from": ["0 mm", "0 mm", "0 mm"], "along": [0, 0, 1]}}
scene
# %%
scene.plot(plane="xz");
# %% [markdown]
# Each 511 keV event emits 17,000 photons, so the response of every 3 mm of every crystal is traced once, and the events
# are made from that map. `results = scene.run(progress=True)` traces every photon instead.
# %%
response = scintray.ResponseMap.build(scene, pitch_mm=3.5, photons_per_cell=10_000, progress=True)
results = response.run(scene, events=40_000)
results
# %%
analysis = results.analyze()
analysis
# %%
analysis.plot();
# %%
results.events().to_dataframe()[["energy_keV", "light", "detected"]].describe()
