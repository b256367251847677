import boresight_widget as bw

settings = {}

capture = bw.Capture(files=["xwr16xx_crw_dca_module_2018_1015v2.bin", "profile.cfg"], **settings)
capture
