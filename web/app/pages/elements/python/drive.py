import boresight_widget as bw

settings = {}

drive = bw.Drive(files=["front_radar.csv.gz", "pose_10hz.csv.gz"], **settings)
drive
