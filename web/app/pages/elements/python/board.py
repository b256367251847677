import boresight_widget as bw

settings = {}

board = bw.Board(files=["xwr16xx_crw_demo_visualizer_2018_1015v2.dat", "profile.cfg"], **settings)
board
