# docker build -t verlet_cable .
# docker run --rm -it --net=host verlet_cable                            the demo without rviz
# docker run --rm -it --net=host -v $PWD:/scenes verlet_cable roslaunch verlet_cable cable.launch scene:=/scenes/mine.yaml
FROM debian:12
COPY . /opt/verlet_cable
RUN apt-get update && /opt/verlet_cable/scripts/demo --headless --seconds 5 && rm -rf /var/lib/apt/lists/*
ENTRYPOINT ["bash", "-c", "source /opt/verlet_cable/build/.ws/devel/setup.bash && exec \"$@\"", "--"]
CMD ["roslaunch", "verlet_cable", "demo.launch", "rviz:=false"]
